"""Up to 64 shapes as constants: the bits of the kernels that find them by trees."""

from typing import Any

import pytest

from glrt.gpu.context import Context
from glrt.gpu.struct_arrays import FILE, MOST_READ, MOST_UNIFORM_BYTES
from glrt.plan.facts import MOST_BAKED, SceneFacts
from glrt.rendering.pipelines import TIERS, Tier, text_of
from glrt.scene.scene import Scene
from tests.accel.test_shapes_by_tree import KINDS, crowd
from tests.support.builders import scene_of, sphere
from tests.support.kernel_text import written_for
from tests.support.meshes import blob, mesh
from tests.support.mixed_scene import MATERIALS
from tests.support.packed import packed
from tests.support.renders import rendered

pytestmark = pytest.mark.usefixtures("exact_kernels")
SMALL: dict[str, Any] = {"width": 24, "height": 24, "bounces": 4}
MANY = 60  # shapes; with the floor they fill two loops where they are of one kind


def bits(scene: Scene, context: Context, tier: Tier) -> bytes:
    """The picture of three samples."""
    return rendered(scene, context, 3, tier=tier, **SMALL).radiance.tobytes()


@pytest.fixture(autouse=True)
def _on_software(context: Context) -> None:
    if not context.is_software:
        pytest.skip("bits are promised on software drivers alone")


def text(scene: Scene, tier: Tier) -> str:
    """The file that is written for a scene."""
    return text_of(packed(scene), tier, MOST_UNIFORM_BYTES)


def lit(scene: Scene) -> Scene:
    """A scene with a lamp in place of some of its shapes; its floor comes last."""
    ball = scene_of([sphere([0, 1.6, 0], 0.3, "lamp")], MATERIALS).objects[0]
    return scene.model_copy(update={"objects": (*scene.objects[:-4], ball, scene.objects[-1])})


@pytest.mark.parametrize("tier", TIERS[1:])
@pytest.mark.slow_cases("placed", "baked")
def test_constants_give_the_bits_of_trees(context: Context, tier: Tier) -> None:
    scene = lit(crowd(MANY, 29))
    assert SceneFacts(scene).tree_kinds
    assert bits(scene, context, tier) == bits(scene, context, "generic")


@pytest.mark.slow
@pytest.mark.parametrize("tier", ["placed", "complete"])
def test_quads_of_two_loops(context: Context, tier: Tier) -> None:
    scene = lit(crowd(MANY, 29, ("quad",)))
    assert bits(scene, context, tier) == bits(scene, context, "generic")


@pytest.mark.slow
@pytest.mark.parametrize("kind", KINDS)
def test_each_kind_fills_two_loops(context: Context, kind: str) -> None:
    scene = lit(crowd(MANY, 37, (kind,)))
    found = SceneFacts(scene)
    assert found.has_sphere_tree or found.tree_kinds
    assert bits(scene, context, "complete") == bits(scene, context, "generic")


@pytest.mark.slow
@pytest.mark.parametrize("kinds", [("quad",), ("sphere", "box")], ids="+".join)
def test_loops_find_the_shapes_that_the_tree_of_a_mesh_has(
    context: Context, kinds: tuple[str, ...]
) -> None:
    ball = scene_of([mesh(blob(2), "brass")], MATERIALS).objects
    scene = crowd(MANY, 31, kinds)
    scene = scene.model_copy(update={"objects": (*scene.objects, *ball)})
    assert set(SceneFacts(scene).tree_kinds) == set(kinds)
    assert bits(scene, context, "complete") == bits(scene, context, "generic")


def test_rows_of_a_large_kind_are_constants_in_loops_alone() -> None:
    scene = crowd(MANY, 29, ("quad", "quad", "quad", "quad", "disk"))
    counts, crowded = SceneFacts(scene).shapes, text(scene, "baked")
    assert "const Quad quad_first_rows[32]" in crowded
    assert f"const Quad quad_second_rows[{counts['quad'] - 32}]" in crowded
    assert "uniform QuadRows" in crowded, "where any of them may be asked for"
    assert f"const Disk disk_first_rows[{counts['disk']}]" in crowded
    assert "const Plane plane_rows[1]" in crowded
    assert "HAS_SECOND_LOOP = true" in crowded
    scene = crowd(30, 29, ("quad",))
    few = text(scene, "baked")
    assert f"const Quad quad_rows[{SceneFacts(scene).shapes['quad']}]" in few
    assert "QuadRows" not in few
    assert "HAS_SECOND_LOOP = false" in few


def test_the_places_of_a_second_loop_follow_those_of_the_first() -> None:
    placed = text(crowd(MANY, 29, ("quad",)), "placed")
    assert "    row.corner = read_rows[1 + index].xyz;" in placed
    assert "    row.corner = read_rows[33 + index].xyz;" in placed
    assert MOST_READ == MOST_BAKED


def test_the_complete_tier_has_lamps_as_constants() -> None:
    complete, baked = (written_for("cornell", tier)[FILE] for tier in ("complete", "baked"))
    assert "const Cluster cluster_rows[1]" in complete
    assert "ClusterRows" not in complete
    assert "uniform ClusterRows" in baked
    assert complete.count("const Quad") == baked.count("const Quad") == 1
