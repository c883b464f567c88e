"""Trees on the disk: found again, known by all that they depend on, limited, and only a cache."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from glrt.accel import shape_tree
from glrt.packing import scene_tree, tree_cache
from glrt.packing.scene_arrays import pack_scene
from glrt.packing.scene_tree import SceneTree, tree_of
from glrt.plan.facts import SceneFacts
from glrt.scene.scene import Scene
from tests.support.builders import MATTE, quad, scene_of
from tests.support.meshes import blob, mesh

Array = np.ndarray[Any, Any]


@pytest.fixture(autouse=True)
def cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A cache folder of the test's own, for trees of any size."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    monkeypatch.setattr(tree_cache, "LEAST", 1)
    return tmp_path / "glrt" / "trees"


@pytest.fixture
def built(monkeypatch: pytest.MonkeyPatch) -> list[None]:
    """An item for each tree that was built."""
    found: list[None] = []

    def build(*given: Any) -> Any:
        found.append(None)
        return shape_tree.build(*given)

    monkeypatch.setattr(scene_tree, "build", build)
    return found


def scene(steps: int = 2, quads: int = 0, **more: Any) -> Scene:
    things = [quad([k / 40 - 0.5, -1, 0], [0.01, 0, 0], [0, 2, 0], "white") for k in range(quads)]
    return scene_of([mesh(blob(steps), "white", **more), *things], {"white": MATTE})


def tree(of: Scene) -> SceneTree:
    found = tree_of(SceneFacts(of))
    assert found
    return found


def same(a: SceneTree, b: SceneTree, of: Scene) -> bool:
    packed = [pack_scene(SceneFacts(of), some) for some in (a, b)]
    return a.stack == b.stack and all(
        packed[0][name].tobytes() == packed[1][name].tobytes()
        and packed[0][name].dtype == packed[1][name].dtype
        for name in ("Slot", "Corner", "Triangle")
    )


@pytest.mark.parametrize("quads", [0, 40])
def test_a_tree_is_built_once(built: list[None], cache: Path, quads: int) -> None:
    first = tree(scene(quads=quads))
    again = tree(scene(quads=quads))
    assert len(built) == 1
    assert len(list(cache.glob("*.npz"))) == 1
    assert same(first, again, scene(quads=quads))


def test_other_places_and_shapes_are_other_trees(built: list[None]) -> None:
    for other in (
        scene(),
        scene(3),
        scene(translate=[1, 0, 0]),
        scene(scale=2.0),
        scene(scale=[-1, 1, 1]),
        scene(quads=40),
        scene(quads=41),
    ):
        tree(other)
    assert len(built) == 7


def test_other_code_builds_again(built: list[None], monkeypatch: pytest.MonkeyPatch) -> None:
    tree(scene())
    monkeypatch.setattr(tree_cache, "_code", lambda: b"other")
    tree(scene())
    assert len(built) == 2


@pytest.mark.parametrize("damage", [b"", b"no archive", None])
def test_a_damaged_file_is_made_again(built: list[None], cache: Path, damage: bytes | None) -> None:
    first = tree(scene())
    (file,) = cache.glob("*.npz")
    file.write_bytes(file.read_bytes()[:300] if damage is None else damage)
    assert same(tree(scene()), first, scene())
    assert len(built) == 2
    tree(scene())
    assert len(built) == 2


def test_a_cache_that_cannot_be_written_is_done_without(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "file").touch()
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "file"))
    assert tree(scene()).triangles.size


def test_the_ones_used_longest_ago_go(
    built: list[None], cache: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    first, second, third = (scene(scale=float(k)) for k in (1, 2, 3))
    tree(first)
    size = sum(file.stat().st_size for file in cache.iterdir())
    monkeypatch.setattr(tree_cache, "MOST_BYTES", int(2.5 * size))
    tree(second)
    tree(first)  # used again
    tree(third)
    assert len(list(cache.iterdir())) == 2
    assert len(built) == 3
    tree(first)
    tree(third)
    assert len(built) == 3
    tree(second)
    assert len(built) == 4


def test_small_trees_are_not_kept(cache: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(tree_cache, "LEAST", 1000)
    tree(scene())
    assert not cache.exists()
