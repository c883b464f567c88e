"""Replayed paths are those of the render: their lights add up to its pixels, bit for bit."""

from typing import Any

import pytest

from glrt.core.errors import UsageError
from glrt.gpu.context import Context
from glrt.image.sources import load
from glrt.rendering.paths.recorder import TOGETHER
from glrt.rendering.paths.replay import _runs, path_replay
from glrt.scene.scene import Scene
from glrt.scene.scenefile.catalog import scene_names
from glrt.settings import settings_for
from tests.support.mixed_scene import everything
from tests.support.pixel_paths import assert_same_bits, camera_picture, replayed

PIXELS = [(3, 5), (9, 11), (12, 13)]
MORE_SCENES = ["methods/mesh", "methods/daylight", "methods/spots", "methods/lattice"]


@pytest.fixture(autouse=True)
def software(context: Context) -> None:
    if not context.is_software:
        pytest.skip("bits are promised on software drivers alone")


def check(scene: Scene, context: Context, **settings: Any) -> None:
    """Three pixels of a small picture."""
    picture = camera_picture(scene, context, **settings)
    for pixel in PIXELS:
        found = replayed(scene, pixel, context, **settings)
        assert found.recipe.settings.samples == len(found.paths) == len(found.radiances)
        assert_same_bits(found, picture(*pixel), str(pixel))


@pytest.mark.slow_cases("naive")
@pytest.mark.parametrize("method", ["naive", pytest.param("nee", marks=pytest.mark.slow), "mis"])
def test_lights_add_up_to_the_pixel(context: Context, method: str) -> None:
    check(everything(), context, method=method)


@pytest.mark.parametrize(
    "settings",
    [
        pytest.param({"sampler": "independent", "seed": 7}, marks=pytest.mark.slow),
        pytest.param({"roulette": False, "bounces": 20}, marks=pytest.mark.slow),
        {"bounces": 0},
        {"tier": "generic", "crop": (2, 4, 12, 11), "width": 20},
    ],
    ids=str,
)
def test_whatever_the_settings(context: Context, settings: dict[str, Any]) -> None:
    check(everything(), context, **settings)


@pytest.mark.slow
@pytest.mark.parametrize("method", ["naive", "nee", "mis"])
@pytest.mark.parametrize("name", [*scene_names(), *MORE_SCENES])
def test_of_every_kind_of_scene(context: Context, name: str, method: str) -> None:
    """Trees, meshes, holes, glass in glass, images, the sun and a sky among them."""
    check(load(name), context, method=method)


def test_a_single_sample_is_that_of_all(context: Context) -> None:
    whole = replayed(everything(), (9, 11), context)
    some = replayed(everything(), (9, 11), context, numbers=[17, 3, 4])
    assert some.paths == tuple(whole.paths[number] for number in (17, 3, 4))
    assert (some.radiances == whole.radiances).all()


def test_records_beyond_the_first_room_are_all_read(
    context: Context, monkeypatch: pytest.MonkeyPatch
) -> None:
    whole = replayed(everything(), (9, 11), context)
    monkeypatch.setattr("glrt.rendering.paths.recorder.FIRST_ROWS", 3)
    assert replayed(everything(), (9, 11), context).paths == whole.paths


def test_samples_of_several_dispatches_are_all_there(
    context: Context, monkeypatch: pytest.MonkeyPatch
) -> None:
    whole = replayed(everything(), (9, 11), context)
    monkeypatch.setattr("glrt.rendering.paths.replay.TOGETHER", 5)
    parts = replayed(everything(), (9, 11), context)
    assert parts.paths == whole.paths
    assert parts.radiances.tobytes() == whole.radiances.tobytes()


def test_runs_are_of_neighbours_and_not_too_long() -> None:
    assert list(_runs([2, 3, 4, 7, 9, 10])) == [(2, 3), (7, 1), (9, 2)]
    assert list(_runs(range(TOGETHER + 1))) == [(0, TOGETHER), (TOGETHER, 1)]
    assert list(_runs([])) == []


@pytest.mark.parametrize("pixel", [(16, 0), (0, 16), (-1, 3), (1, 4)])
def test_a_pixel_that_is_not_rendered_is_refused(context: Context, pixel: tuple[int, int]) -> None:
    with pytest.raises(UsageError, match=rf"pixel {pixel[0]} {pixel[1]} is not in the crop"):
        replayed(everything(), pixel, context, crop=(2, 0, 14, 16))


@pytest.mark.parametrize("number", [-1, 18])
def test_a_sample_that_is_not_there_is_refused(context: Context, number: int) -> None:
    with pytest.raises(UsageError, match=f"no sample {number}: the pixel has 18"):
        replayed(everything(), (3, 3), context, numbers=[number])


@pytest.mark.parametrize("method", ["phong", "blinn", "whitted", "cook"])
def test_models_before_path_tracing_are_refused(context: Context, method: str) -> None:
    scene = everything()
    with (
        pytest.raises(UsageError, match=f"method {method}: it is a lighting model"),
        path_replay(scene, settings_for(scene.render, method=method), context),
    ):
        pass
