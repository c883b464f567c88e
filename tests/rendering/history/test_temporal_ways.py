"""History goes with the ways to render that a window has, and changes the film of none."""

from typing import Any

import numpy as np
import pytest

from glrt.analysis.motion.playing import screen_of
from glrt.analysis.motion.sequences import orbit
from glrt.gpu.context import Context
from glrt.image.sources import load
from glrt.plan.plan import Layering
from glrt.rendering.history.temporal import Mode, Temporal, Way
from glrt.rendering.renderer import Renderer
from glrt.scene.scene import with_lights
from glrt.settings import settings_for
from tests.support.images import same_bits
from tests.support.moving import wall

WAYS: dict[str, dict[str, Any]] = {
    "a crop": {"crop": (3, 2, 9, 7)},
    "AOVs": {"aov": ("albedo", "depth", "object")},
    "Sobol points": {"sampler": "sobol"},
    "a classic model": {"method": "phong"},
    "particles": {"caustics": "on"},
    "a denoiser": {"denoise": "nlm"},
    "layers by groups": {"layering": "groups"},
    "layers by lengths": {"layering": "lengths"},
}


HISTORIES: tuple[Mode, ...] = ("taa", "ataa", "wrls", "upsample")
BOTH: list[tuple[str, Mode]] = [(way, "reproject") for way in WAYS]
BOTH += [(way, mode) for mode in HISTORIES for way in WAYS]


@pytest.mark.slow_cases("particles-*")
@pytest.mark.slow_cases("layers by lengths-ataa")
@pytest.mark.parametrize(("way", "mode"), BOTH)
def test_the_screen_has_history_and_the_film_has_none(
    context: Context, way: str, mode: Mode
) -> None:
    changes = dict(WAYS[way])
    layering: Layering = changes.pop("layering", "none")
    scenes = orbit(load("cornell"), 8, 2.0).scenes[:3]
    usual = {"width": 16, "height": 12, "bounces": 3, "sampler": "independent"}
    settings = settings_for(scenes[0].render, **{**usual, **changes})
    renderer = Renderer(scenes[0], settings, context, layering=layering)
    temporal = Temporal(context.gl, Way(mode))
    for number, scene in enumerate(scenes[1:], 1):
        renderer.render(2)
        temporal.leave(renderer)
        renderer.update(scene, seed=number)
        temporal.arrive(renderer)
    shown = screen_of(renderer.render(2), temporal)
    fresh = Renderer(scenes[-1], settings, context, layering=layering, seed=2).render(2)
    film = fresh.plain_image().radiance
    assert same_bits(renderer.plain_image().radiance, film)
    assert shown.shape == film.shape
    assert np.isfinite(shown).all()
    assert not same_bits(shown, film)
    for part in (temporal, renderer, fresh):
        part.release()


def test_a_crop_shows_that_part_of_the_frame(context: Context) -> None:
    """It is the same to the last bit where no history comes from beyond the crop."""
    scene = wall(background={"bottom": [0.1, 0.2, 0.3], "top": [3.0, 2.0, 1.0]})
    found = []
    for crop in (None, (8, 8, 8, 8)):
        size = {"width": 24, "height": 24, "sampler": "independent", "crop": crop}
        renderer = Renderer(scene, settings_for(scene.render, **size), context)
        temporal = Temporal(context.gl)
        renderer.render(2)
        temporal.leave(renderer)
        renderer.update(seed=1)
        temporal.arrive(renderer)
        found.append(screen_of(renderer.render(2), temporal))
        temporal.release()
        renderer.release()
    assert same_bits(found[0][8:16, 8:16], found[1])


def test_what_is_shown_under_weights_is_history(context: Context) -> None:
    """A lamp that was dimmed by its layer is dim in the next view, too."""
    scene = load("lamps")
    dim = with_lights(scene, {"amber": 0.0, "blue": 0.0, "rose": 0.0})
    settings = settings_for(scene.render, width=16, height=12, bounces=2)
    renderer = Renderer(scene, settings, context, layering="groups")
    temporal = Temporal(context.gl)
    renderer.render(4)
    renderer.update(dim)
    temporal.leave(renderer)
    moved = dim.model_copy(update={"camera": orbit(scene, 8, 1.0).scenes[1].camera})
    renderer.update(moved)
    temporal.arrive(renderer)
    assert screen_of(renderer.render(1), temporal).max() == 0
    temporal.release()
    renderer.release()


class Counted:
    """A context that knows whether it is current."""

    depth = 0

    def __enter__(self) -> None:
        self.depth += 1

    def __exit__(self, *error: object) -> None:
        self.depth -= 1


@pytest.mark.parametrize("mode", ["reproject", *HISTORIES])
def test_what_a_history_holds_is_released_in_its_context(
    mode: Mode, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Without a current context OpenGL would free nothing: each history left 2 to 5 MB."""
    gl, seen = Counted(), []
    temporal = Temporal(gl, Way(mode))  # type: ignore[arg-type]
    for part in (temporal._pass, temporal._surfaces[0], temporal._resolver):
        monkeypatch.setattr(part, "release", lambda: seen.append(gl.depth))
    temporal.release()
    assert seen == [1, 1, 1]
    assert gl.depth == 0
