"""A renderer switches to a kernel with the shapes written into it, and back: no bit changes."""

from typing import Any

import pytest

from glrt.core.errors import RenderError, UsageError
from glrt.gpu.context import Context
from glrt.image.image import Image
from glrt.plan.facts import MOST_BAKED
from glrt.plan.plan import Layering
from glrt.rendering import kernel_switch
from glrt.rendering.pipelines import compiled
from glrt.rendering.renderer import Renderer
from glrt.rendering.schedule import INTERACTIVE
from glrt.scene.materials.lambertian import Lambertian
from glrt.scene.scene import Scene
from glrt.scene.shapes.sphere import Sphere
from glrt.settings import Cost
from glrt.view.controls import replaced
from glrt.view.edits.scene_edits import with_material
from tests.support.builders import MATTE, scene_of, sphere
from tests.support.mixed_scene import OBJECTS, everything
from tests.support.renders import SAMPLERS, rendering, same

pytestmark = pytest.mark.usefixtures("exact_kernels")  # shared ones have no shapes written in

SMALL: dict[str, Any] = {"width": 40, "height": 24, "bounces": 4}


@pytest.fixture
def made(monkeypatch: pytest.MonkeyPatch) -> list[Any]:
    """The kernels that are compiled from here on."""
    kernels: list[Any] = []

    def compiling(*arguments: Any) -> Any:
        kernels.append(compiled(*arguments))
        return kernels[-1]

    monkeypatch.setattr(kernel_switch, "compiled", compiling)
    return kernels


def moved(scene: Scene) -> Scene:
    first = next(shape for shape in scene.objects if isinstance(shape, Sphere))
    aside = replaced(first, center=(0.1, 0.2, 0.3))
    return replaced(
        scene, objects=tuple(aside if shape is first else shape for shape in scene.objects)
    )


def tier_of(image: Image) -> str:
    assert image.recipe
    return image.recipe.tier


def seen(scene: Scene, **changes: Any) -> Scene:
    return replaced(scene, camera=replaced(scene.camera, **changes))


@pytest.mark.slow_cases("compute-none-*")
@pytest.mark.slow_cases("fragment-none-independent")
@pytest.mark.slow_cases("compute-lengths-independent", "compute-lengths-sobol")
@pytest.mark.parametrize("sampler", SAMPLERS)
@pytest.mark.parametrize(
    ("pipeline", "layering"),
    [("compute", "none"), ("compute", "groups"), ("compute", "lengths"), ("fragment", "none")],
)
def test_kernels_that_take_turns_give_the_bits_of_one(
    context: Context, pipeline: Any, layering: Layering, sampler: str
) -> None:
    """Taken over within a block of samples."""
    if not context.is_software:
        pytest.skip("bits are promised on software drivers alone")
    kind: Any = {"pipeline": pipeline, "layering": layering, "sampler": sampler, **SMALL}
    with rendering(everything(), context, **kind) as plain:
        expected = plain.render(37).image()
    with rendering(everything(), context, **kind) as renderer:
        renderer.render(5)
        assert not renderer.is_baked
        assert renderer.bake("placed")
        assert renderer.running_tier == "placed"
        renderer.render(9)
        assert renderer.bake()
        assert renderer.is_baked
        image = renderer.render(37).image()
        assert same(image, expected)
        assert image.recipe == expected.recipe, "nobody can tell when it was"


def test_a_recipe_reports_kernels_that_took_turns_where_a_driver_may_report_them_apart(
    context: Context, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Then no render gives the same bits, and none goes on from there."""
    monkeypatch.setattr(Context, "is_software", False)
    with rendering(everything(), context, sampler="sobol", **SMALL) as renderer:
        renderer.render(16)
        assert tier_of(renderer.image()) == "generic"
        renderer.bake()
        mixed = renderer.render(32).image()
        assert tier_of(mixed) == "baked and generic"
        with pytest.raises(UsageError, match="tier is baked and generic in the picture"):
            Renderer(everything(), renderer.settings, context, "baked").resume(mixed)
        renderer.restart()
        assert tier_of(renderer.render(32).image()) == "baked"


def test_a_frame_that_has_begun_is_begun_again(
    context: Context, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The first dispatch of a kernel writes to it."""
    monkeypatch.setattr("glrt.rendering.renderer.INTERACTIVE", INTERACTIVE._replace(limit=1e-12))
    with rendering(everything(), context, **SMALL) as renderer:
        renderer.render(2)
        renderer.advance(0.0, 9)
        assert renderer.work > 2
        renderer.bake()
        assert renderer.work == 2
        with rendering(everything(), context, **SMALL) as plain:
            assert same(renderer.render(4).image(), plain.render(4).image())


@pytest.mark.parametrize("edit", [moved, lambda scene: seen(scene, position=(0.3, 0.2, 3.0))])
def test_a_change_of_what_is_written_in_compiles_nothing(
    fresh: Context, made: list[Any], edit: Any
) -> None:
    with (
        rendering(everything(), fresh, **SMALL) as renderer,
        rendering(edit(everything()), fresh, **SMALL) as plain,
    ):
        assert len(made) == 1, "two renderers of one kernel share it"
        renderer.render(2).bake()
        assert len(made) == 2
        assert renderer.update(edit(everything())) is Cost.RESTART
        assert not renderer.is_baked
        assert len(made) == 2
        assert same(renderer.render(6).image(), plain.render(6).image())
        assert renderer.bake()
        assert len(made) == 3
        assert same(renderer.render(9).image(), plain.render(9).image())
        renderer.update(everything())
        assert renderer.is_baked, "a baked kernel is kept for a while"
        assert len(made) == 3


@pytest.mark.parametrize("edit", [moved, lambda scene: seen(scene, position=(0.3, 0.2, 3.0))])
def test_a_kernel_that_reads_places_stays_where_things_move(
    fresh: Context, made: list[Any], edit: Any
) -> None:
    """It is kept while a faster one has its turn."""
    with (
        rendering(everything(), fresh, **SMALL) as renderer,
        rendering(edit(everything()), fresh, **SMALL) as plain,
    ):
        renderer.render(2).bake("placed")
        assert not renderer.bake("placed")
        assert renderer.bake()
        assert len(made) == 3
        assert renderer.update(edit(everything())) is Cost.RESTART
        assert renderer.running_tier == "placed"
        assert same(renderer.render(6).image(), plain.render(6).image())
        renderer.update(everything())
        assert renderer.running_tier == "placed"
        assert len(made) == 3


def test_a_kernel_that_reads_places_ends_its_turn_where_a_size_changes(
    fresh: Context, made: list[Any]
) -> None:
    wider = [shape | {"radius": 0.7} if shape.get("radius") == 0.6 else shape for shape in OBJECTS]
    with rendering(everything(), fresh, **SMALL) as renderer:
        renderer.render(2).bake("placed")
        assert renderer.update(everything(wider)) is Cost.RESTART
        assert renderer.running_tier == "generic"
        assert len(made) == 2


@pytest.mark.parametrize("tier", ["placed", "baked"])
def test_a_tier_of_its_own_gives_the_same_bits_from_every_place(
    context: Context, tier: Any
) -> None:
    if not context.is_software:
        pytest.skip("bits are promised on software drivers alone")
    with rendering(everything(), context, tier=tier, **SMALL) as renderer:
        for scene in (everything(), moved(everything())):
            renderer.update(scene)
            assert renderer.tier == tier
            with rendering(scene, context, **SMALL) as plain:
                assert same(renderer.render(5).image(), plain.render(5).image())


@pytest.mark.parametrize(
    ("edit", "changes"),
    [
        (lambda scene: seen(scene, look_at=(0.2, 0.1, 0.0)), {}),
        (lambda scene: with_material(scene, "white", color=(0.2, 0.9, 0.4)), {}),
        (lambda scene: scene, {"seed": 3}),
        (lambda scene: scene, {"width": 24, "height": 40}),
        (lambda scene: scene, {"bounces": 2}),
    ],
    ids=["turned", "colour", "seed", "size", "bounces"],
)
def test_other_changes_leave_the_faster_kernel_its_turn(
    context: Context, monkeypatch: pytest.MonkeyPatch, edit: Any, changes: dict[str, Any]
) -> None:
    """The camera may turn: only its place is in what is written in."""
    after = edit(everything())
    assert isinstance(after.materials["white"], Lambertian)
    with rendering(everything(), context, **SMALL) as renderer:
        renderer.render(2).bake()
        monkeypatch.setattr(kernel_switch, "compiled", None)  # nothing is compiled
        assert renderer.update(after, **changes) is Cost.RESTART
        assert renderer.is_baked
        monkeypatch.undo()
        with rendering(after, context, **{**SMALL, **changes}) as plain:
            assert same(renderer.render(5).image(), plain.render(5).image())


def test_another_kernel_ends_the_turn(fresh: Context, made: list[Any]) -> None:
    with rendering(everything(), fresh, **SMALL) as renderer:
        renderer.render(2).bake()
        assert renderer.update(method="naive") is Cost.RECOMPILE
        assert not renderer.is_baked
        assert len(made) == 3
        renderer.update(method="mis")
        assert len(made) == 3, "the kernel from before is known still"


def test_many_shapes_are_not_written_in_nor_twice(context: Context) -> None:
    balls = [sphere([i, 0, -9], 0.4, "m") for i in range(MOST_BAKED + 1)]
    many = scene_of(balls, {"m": MATTE}, background={"color": [1, 1, 1]})
    with rendering(many, context, **SMALL) as renderer:
        assert not renderer.bake()
        assert not renderer.is_baked
    with rendering(everything(), context, tier="baked", **SMALL) as renderer:
        assert not renderer.bake()
        assert renderer.is_baked


def test_a_kernel_that_is_refused_changes_nothing(
    fresh: Context, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(*_: object) -> None:
        raise RenderError("not this one")

    with rendering(everything(), fresh, **SMALL) as renderer:
        renderer.render(3)
        monkeypatch.setattr(kernel_switch, "compiled", refuse)
        with pytest.raises(RenderError, match="not this one"):
            renderer.bake()
        monkeypatch.undo()
        assert not renderer.is_baked
        plain = Renderer(everything(), renderer.settings, fresh).render(5)
        assert same(renderer.render(5).image(), plain.image())
        plain.release()
