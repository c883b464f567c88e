"""AOVs of a render that is edited, cut into parts, resumed or refused."""

from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from glrt.core.errors import RenderError, SceneError, UsageError
from glrt.gpu.context import Context
from glrt.image.aovs import AovImages
from glrt.image.image import Image
from glrt.rendering import aov_tracer
from glrt.rendering.renderer import Renderer
from glrt.scene.scene import Scene
from glrt.settings import Aov, Cost
from tests.support.aov_scenes import heap
from tests.support.builders import MATTE, plane, scene_of, sphere
from tests.support.first_hits import ALL, MEANS, same_aovs
from tests.support.renders import rendered, rendering, same

SOME: tuple[Aov, ...] = ("depth", "object")
SMALL: dict[str, Any] = {"width": 8, "height": 8, "bounces": 2, "sampler": "sobol"}


def counts(aovs: AovImages, name: Aov = "albedo") -> set[int]:
    """How many samples pixels have, of an AOV that counts them all."""
    count = aovs[name].count
    assert count is not None
    return {int(n) for n in np.unique(count)}


def alone(context: Context, samples: int, aov: tuple[Aov, ...] = ALL, **more: Any) -> AovImages:
    """The AOVs of one render."""
    return rendered(heap(), context, samples, **{**SMALL, "aov": aov, **more}).aovs


# --- how many samples ------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("sampler", "samples", "gathered"),
    [("sobol", 1, 16), ("sobol", 16, 16), ("sobol", 20, 32), ("independent", 20, 20)],
)
def test_aovs_are_gathered_in_whole_observations(
    context: Context, sampler: str, samples: int, gathered: int
) -> None:
    found = alone(context, samples, sampler=sampler)
    assert counts(found) == {gathered}
    block = 16 if sampler == "sobol" else 1
    for name in MEANS:
        aov = found[name]
        assert aov.observations is not None
        assert aov.stderr is not None
        assert aov.observations.max() == gathered // block
        assert np.array_equal(np.isnan(aov.stderr.reshape(64, -1)[:, 0]), _few(aov.observations))
    assert same_aovs(found, alone(context, gathered, sampler=sampler))


def _few(observations: Any) -> Any:
    return observations.ravel() < 2


def test_a_window_works_on_picture_and_aovs(context: Context) -> None:
    """It calls `advance`, which ends when both are done; then there is nothing to change."""
    with rendering(heap(), context, **SMALL, aov=ALL) as renderer:
        while renderer.lacks(20):
            renderer.advance(0.01, 20)
        assert renderer.shown == (20, 32)
        assert not renderer.advance(0.01, 20)
        assert same_aovs(renderer.image().aovs, alone(context, 20))


# --- edits -----------------------------------------------------------------------------------


def test_other_aovs_keep_the_samples_and_are_those_of_all(context: Context) -> None:
    plain = rendered(heap(), context, 40, **SMALL)
    with rendering(heap(), context, **SMALL) as renderer:
        renderer.render(40)
        wanted: list[tuple[Aov, ...]] = [ALL, SOME, (), ("normal",), ALL]
        for aov in wanted:
            assert renderer.update(aov=aov) is Cost.FREE
            assert renderer.samples == 40
            image = renderer.image()
            assert same(image, plain)
            assert [*image.aovs] == [*aov]
            assert not aov or same_aovs(image.aovs, alone(context, 40, aov))
            assert image.recipe
            assert image.recipe.settings.aov == aov
        assert renderer.update(aov=ALL) is None
        renderer.render(50)
        assert same_aovs(renderer.image().aovs, alone(context, 50))


def moved() -> Scene:
    ball = heap().objects[3].model_copy(update={"center": (-0.5, -0.25, 0.0)})
    objects = (*heap().objects[:3], ball, *heap().objects[4:])
    return heap().model_copy(update={"objects": objects})


@pytest.mark.parametrize(
    "change",
    [{"scene": moved()}, {"seed": 5}, {"crop": (2, 1, 5, 6)}, {"sampler": "independent"}],
    ids=["scene", "seed", "crop", "sampler"],
)
def test_an_edit_restarts_aovs_and_leaves_nothing_behind(
    context: Context, change: dict[str, Any]
) -> None:
    scene, settings = change.get("scene", heap()), {k: v for k, v in change.items() if k != "scene"}
    with rendering(heap(), context, **SMALL, aov=ALL) as renderer:
        before = renderer.render(40).image().aovs
        renderer.update(**change)
        assert renderer.shown == (0, 0)
        after = renderer.render(20).image().aovs
        expected = rendered(scene, context, 20, **{**SMALL, "aov": ALL, **settings}).aovs
        assert same_aovs(after, expected)
        assert not same_aovs(after, before)
        renderer.update(**{**dict(renderer.settings), "scene": heap(), **SMALL, "crop": None})
        renderer.update(seed=0)
        assert same_aovs(renderer.render(40).image().aovs, before)


def test_a_restart_restarts_aovs(context: Context) -> None:
    with rendering(heap(), context, **SMALL, aov=ALL) as renderer:
        renderer.render(40).image()
        renderer.restart()
        assert renderer.shown == (0, 0)
        assert same_aovs(renderer.render(16).image().aovs, alone(context, 16))


def test_an_unknown_aov_is_refused_by_its_name(context: Context) -> None:
    with pytest.raises(UsageError, match=r"aov.*'depht'"):
        Renderer(heap(), context=context, aov=("depht",))  # type: ignore[arg-type]


# --- refusals --------------------------------------------------------------------------------


@cache
def tiles(count: int) -> Scene:
    """So many planes, one behind the other, that the first hides."""
    walls = [plane([0, 0, -3 - 0.001 * n], [0, 0, 1], "matte") for n in range(count)]
    return scene_of(walls, {"matte": MATTE}, background={"color": [1, 1, 1]})


@pytest.fixture
def software(context: Context) -> None:
    if not context.is_software:
        pytest.skip("this machine renders on hardware")


@pytest.fixture
def short_loops(monkeypatch: pytest.MonkeyPatch) -> None:
    """The driver ends loops where 16 rays take 40 quads, and single ones far fewer."""
    monkeypatch.setattr(aov_tracer, "usable_rounds", lambda _: 600)


NAIVE: dict[str, Any] = {**SMALL, "bounces": 0, "method": "naive"}


@pytest.mark.slow
@pytest.mark.usefixtures("exact_kernels")
@pytest.mark.usefixtures("short_loops")
def test_aovs_beyond_the_loop_limit_are_refused_and_leave_the_picture(context: Context) -> None:
    with pytest.raises(SceneError, match="--aov is beyond this driver's loop limit"):
        Renderer(tiles(40), context=context, aov=SOME, **NAIVE)
    with rendering(tiles(40), context, **NAIVE) as renderer:
        before = renderer.render(1).image()
        with pytest.raises(SceneError, match=r"16 camera rays .* 672 rounds .* 600"):
            renderer.update(aov=SOME)
        assert renderer.settings.aov == ()
        assert same(renderer.image(), before)
        assert renderer.render(2).samples == 2
        assert renderer.update(sampler="independent", aov=SOME) is Cost.RECOMPILE
        assert counts(renderer.render(3).image().aovs, "depth") == {3}


@pytest.mark.usefixtures("short_loops")
def test_a_scene_beyond_the_loop_limit_leaves_aovs_as_they_were(context: Context) -> None:
    with rendering(heap(), context, **NAIVE, aov=ALL) as renderer:
        before = renderer.render(20).image()
        with pytest.raises(SceneError, match="loop limit"):
            renderer.update(tiles(40))
        assert renderer.scene == heap()
        assert renderer.shown == (20, 32)
        assert same_aovs(renderer.image().aovs, before.aovs)
        assert same_aovs(renderer.render(40).image().aovs, alone(context, 40, **NAIVE))


@pytest.mark.slow
@pytest.mark.usefixtures("loop_limit")
def test_a_loop_limit_as_that_of_llvmpipe_is_heeded(context: Context) -> None:
    """A sample of 4000 quads fits into a dispatch, and 16 camera rays do not; of 3000 they do."""
    with pytest.raises(SceneError, match="--aov is beyond"):
        Renderer(tiles(4000), context=context, aov=SOME, **NAIVE)
    assert counts(rendered(tiles(3000), context, 40, **NAIVE, aov=SOME).aovs, "depth") == {48}


def test_aovs_that_the_driver_refuses_leave_those_from_before(
    context: Context, monkeypatch: pytest.MonkeyPatch
) -> None:
    with rendering(heap(), context, **SMALL, aov=SOME) as renderer:
        before = renderer.render(20).image()

        def refuse(*_: object) -> None:
            raise RenderError("the driver refuses a shader")

        monkeypatch.setattr(aov_tracer, "ready", refuse)
        with pytest.raises(RenderError, match="refuses"):
            renderer.update(aov=ALL)
        monkeypatch.undo()
        assert renderer.settings.aov == SOME
        assert same_aovs(renderer.image().aovs, before.aovs)
        assert renderer.update(aov=ALL) is Cost.FREE
        assert same_aovs(renderer.image().aovs, alone(context, 20))


@pytest.mark.usefixtures("software")
def test_aovs_of_a_scene_that_grew_lose_no_sample(context: Context) -> None:
    """More quads by the same kernel: a dispatch takes fewer samples then, as at the start."""
    options = {"width": 8, "height": 8, "bounces": 0, "aov": SOME}
    with rendering(tiles(17), context, **options) as renderer:
        assert renderer.update(tiles(32)) is Cost.RESTART
        while renderer.samples < 8000:
            renderer.step(min(renderer.most_samples, 8000 - renderer.samples))
        assert counts(renderer.image().aovs, "depth") == {8000}


# --- pictures that go on, and parts ------------------------------------------------------------


@pytest.mark.parametrize("first", [7, 16, 21])
def test_a_resumed_picture_has_the_aovs_of_one_render(
    context: Context, tmp_path: Path, first: int
) -> None:
    """The files are the same to the byte."""
    options: dict[str, Any] = {**SMALL, "samples": 64, "aov": ALL}
    begun, on, whole = (Renderer(heap(), context=context, **options) for _ in range(3))
    begun.render(first).image().save(tmp_path / "first.exr")
    on.resume(Image.load(tmp_path / "first.exr"))
    on.render(40).image().save(tmp_path / "on.exr")
    whole.render(40).image().save(tmp_path / "whole.exr")
    assert (tmp_path / "on.exr").read_bytes() == (tmp_path / "whole.exr").read_bytes()
    for renderer in (begun, on, whole):
        renderer.release()


def test_a_picture_that_goes_on_in_place_of_another_has_its_own_aovs(context: Context) -> None:
    """The renderer forgets the AOVs that it gathered for the other picture."""
    with rendering(heap(), context, **SMALL, aov=ALL) as renderer:
        first = renderer.render(16).image()
        renderer.render(64).image()
        renderer.resume(first)
        assert renderer.shown == (16, 0)
        assert same_aovs(renderer.image().aovs, first.aovs)
        assert same_aovs(renderer.render(20).image().aovs, alone(context, 20))


def test_aovs_asked_for_later_are_those_of_the_part(context: Context) -> None:
    """They begin with the first sample of the part, not with that of the render."""
    options: dict[str, Any] = {**SMALL, "samples": 96, "part": (2, 3), "context": context}
    at_once, later = Renderer(heap(), **options, aov=ALL), Renderer(heap(), **options)
    expected = at_once.render().image().aovs
    later.render()
    assert later.update(aov=ALL) is Cost.FREE
    assert same_aovs(later.image().aovs, expected)
    assert not same_aovs(expected, alone(context, 32))
    at_once.release()
    later.release()


@pytest.mark.slow
def test_a_part_has_aovs_of_its_own_samples(context: Context) -> None:
    """Parts of one sample each have seeds of their own; their mean is that of the render."""
    options: dict[str, Any] = {**SMALL, "sampler": "independent", "aov": ("depth",)}
    ball = scene_of([sphere([0, 0, 0], 2.0, "matte")], {"matte": MATTE})
    renderer = Renderer(ball, context=context, part=(1, 4), samples=4, **options)
    values = []
    for number in (1, 2, 3, 4):
        renderer.begin_part(number)
        values.append(renderer.render().image().aovs["depth"].value.astype(np.float64))
    renderer.release()
    whole = rendered(ball, context, 4, **options).aovs["depth"]
    assert np.abs(np.mean(values, axis=0) - whole.value).max() < 1e-6
    assert whole.stderr is not None
    assert np.allclose(np.std(values, axis=0, ddof=1) / 2, whole.stderr, rtol=1e-4)
