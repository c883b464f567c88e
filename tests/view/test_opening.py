"""Large scenes are read by a thread, which reports how far it is; no window is opened."""

import pickle
from collections.abc import Callable
from pathlib import Path
from threading import Event

import numpy as np
import pytest

from glrt.accel import binary_tree
from glrt.core.errors import GlrtError, SceneError
from glrt.core.stages import listened, report
from glrt.image.sources import STRICT, load, load_recipe
from glrt.packing.ready_tree import build_ahead, ready_or_new
from glrt.plan.facts import SceneFacts
from glrt.settings import settings_for
from glrt.view import opening
from glrt.view.kernel_notes import Driver
from glrt.view.opening import Aside, Finish, Opening, as_read, is_large
from glrt.view.scene_compiler import Part, compile_for

CUBE = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"
SCENE = "[camera]\nposition = [0, 0, 5]\nlook_at = [0, 0, 0]\n[background]\ncolor = [1, 1, 1]\n"
MESH = '[materials.m]\ntype = "lambertian"\ncolor = [1, 1, 1]\n[[objects]]\nshape = "mesh"\n'


@pytest.fixture
def model(tmp_path: Path) -> Path:
    file = tmp_path / "cube.obj"
    file.write_text(CUBE)
    return file


def test_a_scene_is_large_by_the_models_that_it_names(
    model: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    named = model.with_name("named.toml")
    named.write_text(f'{SCENE}{MESH}file = "cube.obj"\nmaterial = "m"\n')
    plain = model.with_name("plain.toml")
    plain.write_text(SCENE)
    sources = [str(model), str(named), str(plain), "cornell", "-"]
    assert [is_large(source) for source in sources] == [False] * 5
    monkeypatch.setattr(opening, "LARGE", len(CUBE))
    assert [is_large(source) for source in sources] == [True, True, False, False, False]
    with pytest.raises(SceneError, match="cornel"):
        is_large("cornel")


def test_a_scene_that_is_read_aside_is_that_of_load(model: Path) -> None:
    aside, taken = Aside(), list[object]()
    aside.begin(str(model))
    assert aside.opening
    assert aside.text.startswith("cube.obj: ")
    aside.opening.result()
    aside.follow(lambda *found: taken.extend(found))
    assert taken == [str(model), load(model), load(model).render, STRICT]
    assert aside.text == ""


def test_a_scene_that_nobody_waits_for_is_not_taken(
    model: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    gate, read = Event(), load_recipe
    monkeypatch.setattr(opening, "load_recipe", lambda *given: gate.wait(60) and read(*given))
    built = list[object]()
    monkeypatch.setattr(opening, "build_ahead", lambda *given: built.append(given))
    aside = Aside()
    aside.begin(str(model))
    begun = aside.opening
    assert begun
    aside.end()
    gate.set()
    begun._thread.join()
    assert built == []
    aside.follow(lambda *_: pytest.fail("it was given up"))


def test_a_wrong_file_is_refused_once(model: Path) -> None:
    model.write_text("v 0 0\nf 1 2 3\n")
    for refuses in (True, False):
        aside, problems = Aside(), list[GlrtError]()
        aside.begin(str(model))
        aside.refuse = problems.append if refuses else None
        assert aside.opening
        aside.opening._thread.join()
        if refuses:
            aside.follow(lambda *_: None)
            assert "cube.obj" in str(problems[0])
        else:
            with pytest.raises(SceneError, match=r"cube\.obj"):
                aside.follow(lambda *_: None)
        assert aside.refuse is None
        assert aside.text == ""


def test_the_share_of_a_tree_grows_to_nearly_one() -> None:
    low = np.random.default_rng(1).random((4096, 3))
    shares = list[float]()
    with listened(lambda stage, share: shares.append(share) if stage == "tree" else None):
        binary_tree.build(low, low + 0.01)
    report("tree", 1.0)  # which nobody hears
    assert shares == sorted(shares)
    assert shares[0] == 0.0
    assert 0.8 < shares[-1] <= 1.0
    assert max(np.diff(shares)) < 0.15


def test_the_tree_that_was_built_ahead_is_used_for_its_objects_alone(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    scene, other = load("spot"), load("spot")
    build_ahead(scene, "moved")
    built = SceneFacts(other, "moved"), SceneFacts(scene, "repeated"), SceneFacts(scene, "moved")
    calls = list[SceneFacts]()
    monkeypatch.setattr(
        "glrt.packing.ready_tree.tree_of", lambda facts, before: calls.append(facts)
    )
    trees = [ready_or_new(facts, None) for facts in (*built, built[2])]
    assert trees[2] is not None
    assert calls == [built[0], built[1], built[2]]


def test_a_large_scene_is_compiled_before_it_is_ready(
    model: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    parts, stages = list[Part](), list[str]()
    driver = Driver("llvmpipe", "compute")

    def compiled(part: Part, goes_on: Callable[[], object]) -> bool:
        goes_on()
        parts.append(part)
        is_there.wait(100)
        stages.append(read.text)
        return True

    is_there = Event()
    monkeypatch.setattr(opening, "compile_for", compiled)
    read = Opening(str(model), STRICT, driver=driver)
    is_there.set()
    scene, _ = read.result()
    assert stages == ["compiling"]
    assert [(part[0], part[3]) for part in parts] == [(scene, driver)]
    assert parts[0][2] == "groups"


def test_a_kernel_that_the_driver_keeps_is_not_compiled_again(
    model: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    parts = list[Part]()
    monkeypatch.setattr(opening, "compile_for", lambda part, _: parts.append(part))
    driver, aside = Driver("llvmpipe", "compute"), Aside()
    aside.driver = lambda: driver

    def opened(seconds: float, finish: Finish = as_read) -> int:
        aside.begin(str(model), STRICT, finish)
        assert aside.opening
        aside.opening._thread.join()
        aside.follow(lambda *_: None)
        aside.learn(seconds)
        return len(parts)

    assert opened(0.1) == 1
    assert opened(9.0) == 1, "the note says that the driver has it"
    assert opened(0.1) == 2, "it took long, so that the driver has lost it"
    driver = driver._replace(version="another")
    assert opened(0.1) == 3
    monkeypatch.setenv("MESA_SHADER_CACHE_DISABLE", "true")
    assert opened(0.1) == 4
    assert opened(0.1, lambda scene, given: (scene, settings_for(given, method="naive"))) == 5


def test_a_compilation_that_nobody_waits_for_ends(model: Path) -> None:
    scene = load(model)
    part: Part = (
        scene,
        settings_for(scene.render),
        "none",
        Driver("no driver of this name", "compute"),
    )

    def give_up() -> None:
        raise KeyError("given up")

    with pytest.raises(KeyError, match="given up"):
        compile_for(part, give_up)
    assert not compile_for(part, lambda: None), "there is no such driver"


def test_a_mesh_has_the_same_forms_in_another_process(model: Path) -> None:
    model.write_text(CUBE + "s 1\n")
    mesh = load(model).meshes[0]
    again = pickle.loads(pickle.dumps(mesh))
    assert again == mesh
    assert (again.world_normals == mesh.world_normals).all()


def test_stages_are_told_in_words(model: Path) -> None:
    read = Opening(str(model), STRICT)
    read.result()
    read.stage, read.share = "tree", 0.434
    assert read.text == "tree 43 %"
    read.share = 0.0
    assert read.text == "tree"
