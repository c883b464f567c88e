"""A scene that is slow for a reason that the user can change says which."""

from pathlib import Path

import numpy as np
import pytest

from glrt.cli.main import main
from glrt.image.sources import load
from glrt.plan.facts import SceneFacts
from glrt.plan.slow_scenes import slow_because
from glrt.scene.scene import Scene
from glrt.scene.scenefile.toml_writer import write_scene
from glrt.settings import Settings, settings_for
from tests.support.builders import MATTE, lamp, plane, quad, scene_of, sphere
from tests.support.meshes import mesh


def planes(count: int) -> Scene:
    walls = [plane([0, 0, -1 - k], [0, 0, 1], "white") for k in range(count)]
    return scene_of(walls, {"white": MATTE}, background={"color": [1, 1, 1]})


def settings(**changes: object) -> Settings:
    return settings_for(Settings(), **changes)


def test_shapes_without_a_tree_are_counted() -> None:
    assert slow_because(SceneFacts(planes(32)), settings()) == []
    (text,) = slow_because(SceneFacts(planes(600)), settings())
    assert "compared with 600 planes one by one" in text
    assert "Quads have" in text


def test_what_has_an_end_has_a_tree() -> None:
    things = [quad([0.2 * k, 0, -1], [0.1, 0, 0], [0, 0.1, 0], "white") for k in range(100)]
    things += [sphere([k, 0, -9], 0.4, "white") for k in range(40)]
    assert slow_because(SceneFacts(scene_of(things, {"white": MATTE})), settings()) == []


@pytest.mark.parametrize(
    ("count", "method", "is_slow"),
    [(65_535, "mis", False), (65_536, "mis", True), (65_536, "naive", False)],
)
def test_lamps_of_too_many_triangles_are_reported(count: int, method: str, is_slow: bool) -> None:
    vertices = np.concatenate([np.eye(3), np.random.default_rng(1).normal(size=(count - 1, 3))])
    faces = [[0, 1, 2]] + [[0, 1, k + 3] for k in range(count - 1)]
    scene = scene_of([mesh((vertices, np.array(faces)), "lamp")], {"lamp": lamp(1.0)})
    found = slow_because(SceneFacts(scene), settings(method=method))
    assert ["65,536 triangles emit" in text for text in found] == [True] * is_slow


@pytest.mark.parametrize(
    ("changes", "is_slow"),
    [
        ({"roulette": False, "bounces": 200}, True),
        ({"roulette": False, "bounces": 5}, False),
        ({"roulette": True, "bounces": 200}, False),
        ({"roulette": False, "bounces": 200, "method": "whitted"}, False),
    ],
)
def test_paths_without_an_end_are_reported(changes: dict[str, object], is_slow: bool) -> None:
    found = slow_because(SceneFacts(load("cornell")), settings(**changes))
    assert ["--no-roulette" in text for text in found] == [True] * is_slow


def test_render_and_inspect_say_it(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "many.toml"
    write_scene(planes(33), file)
    size = ["--width", "8", "--height", "8", "--samples", "1"]
    assert main(["render", str(file), *size, "-o", str(tmp_path / "a.png")]) == 0
    assert "glrt: slow: each ray is compared with 33 planes" in capsys.readouterr().err
    assert main(["render", str(file), *size, "-o", str(tmp_path / "a.png"), "--quiet"]) == 0
    assert not capsys.readouterr().err
    assert main(["inspect", str(file)]) == 0
    assert "slow: each ray is compared with 33 planes" in capsys.readouterr().out
