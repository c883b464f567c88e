"""Particles from lamps: the same light as without them, the same bits every time, known errors."""

from typing import Any

import numpy as np
import pytest

from glrt.cli.main import main
from glrt.core.errors import RenderError
from glrt.gpu.context import Context
from glrt.image.image import Image
from glrt.image.sources import load
from glrt.image.tonemap import expose_and_encode
from glrt.packing import particles
from glrt.rendering import particle_tracer
from glrt.rendering.device_scene import DeviceScene
from glrt.rendering.particle_tracer import ParticleTracer
from glrt.rendering.renderer import Renderer
from glrt.rendering.schedule import DispatchRange, Schedule
from tests.support.builders import (
    MATTE,
    box_of_quads,
    glass,
    lamp,
    plane,
    quad,
    scene_of,
    sphere,
)
from tests.support.images import same_bits
from tests.support.particle_rooms import BALL, CAMERA, LAMP, MATERIALS, POLISHED, ROOMS
from tests.support.renders import assert_agree, rendered, rendering, same

ON: dict[str, Any] = {"caustics": "on", "linked": 0.0}


@pytest.mark.slow
@pytest.mark.parametrize("name", ROOMS)
def test_particles_change_the_noise_alone(context: Context, name: str) -> None:
    size: dict[str, Any] = {"width": 32, "height": 32, "bounces": 6}
    without = rendered(ROOMS[name], context, 4096, seed=1, **size)
    image = rendered(ROOMS[name], context, 1024, **size, **ON, particles=0.5)
    assert_agree(image, without, within=0.05)


@pytest.mark.slow
@pytest.mark.parametrize("name", POLISHED)
def test_light_that_polish_mirrors_is_counted_once(context: Context, name: str) -> None:
    """Smooth coats and smooth metal, flat and on meshes with soft edges."""
    size: dict[str, Any] = {"width": 16, "height": 16, "bounces": 4}
    without = rendered(POLISHED[name], context, 8192, seed=1, **size)
    image = rendered(POLISHED[name], context, 4096, **size, **ON, particles=1.0)
    assert_agree(image, without, within=0.03)


@pytest.mark.slow
def test_a_link_through_rough_glass_knows_what_lies_on_each_side(context: Context) -> None:
    """A lamp behind a tinted ball of it.

    Links that leave the ball cross air, which absorbs nothing: otherwise a fifth of green is lost.
    Links that enter it are shaded by its near wall: otherwise a quarter of blue comes in addition.
    """
    tint = {"attenuation_color": [0.1, 0.5, 1.0], "attenuation_distance": 1.0}
    materials = {"glass": glass(1.5, roughness=0.4, **tint), "lamp": lamp(6.0)}
    things = [sphere([0, 0, 0], 1, "glass"), sphere([0.2, 0.1, -1.8], 0.3, "lamp")]
    camera = {"position": [0, 0, 5], "look_at": [0, 0, 0], "fov": 30}
    scene = scene_of(things, materials, camera)
    without = rendered(scene, context, 1024, seed=1, bounces=4)
    image = rendered(scene, context, 1024, bounces=4, **ON, particles=1.0)
    assert_agree(image, without, within=0.03)


@pytest.mark.slow
def test_particles_pass_rough_panes_as_paths_do(context: Context) -> None:
    """A lamp behind a rough pane, and a ball of glass that focuses its light onto the floor."""
    materials = {
        "pane": glass(1.5, roughness=0.6, thin=True),
        "glass": glass(1.5),
        "lamp": lamp(20.0),
        "floor": MATTE,
    }
    things = [
        quad([-1.2, -1, -0.6], [2.4, 0, 0], [0, 2, 0.3], "pane"),
        sphere([0.3, 0.2, -1.8], 0.4, "lamp"),
        sphere([0.4, -0.6, 0.5], 0.4, "glass"),
        plane([0, -1, 0], [0, 1, 0], "floor"),
    ]
    camera = {"position": [-1, 1.5, 5], "look_at": [0, -0.4, 0], "fov": 35}
    scene = scene_of(things, materials, camera)
    size: dict[str, Any] = {"width": 32, "height": 32, "bounces": 5}
    without = rendered(scene, context, 4096, seed=1, **size)
    image = rendered(scene, context, 1024, **size, **ON, particles=1.0)
    assert_agree(image, without, within=0.04)


@pytest.mark.slow
@pytest.mark.parametrize(("particles", "aimed"), [(0.05, 0.98), (4.0, 0.0), (1.0, 0.5)])
@pytest.mark.parametrize("sampler", ["sobol", "independent"])
def test_however_many_there_are(
    context: Context, particles: float, aimed: float, sampler: str
) -> None:
    scene, more = ROOMS["a ball of glass"], {"particles": particles, "aimed": aimed}
    size: dict[str, Any] = {"width": 32, "height": 32, "bounces": 4}
    without = rendered(scene, context, 4096, seed=1, **size)
    image = rendered(scene, context, 512, **size, **ON, **more, sampler=sampler)
    assert_agree(image, without, within=0.05)


@pytest.mark.slow
def test_the_error_falls_where_light_comes_through_glass(context: Context) -> None:
    """The error over the floor under the ball falls by a factor of 2.2."""
    scene = ROOMS["a ball of glass"]
    size: dict[str, Any] = {"width": 48, "height": 48, "sampler": "sobol", "particles": 1.0}
    errors = [
        float(np.square(rendered(scene, context, 256, **size, **way).stderr[38:]).mean()) ** 0.5
        for way in ({}, ON)
    ]
    assert errors[1] < errors[0] / 1.8


@pytest.mark.slow
@pytest.mark.parametrize("name", ["a ball of glass", "lamps of several kinds"])
def test_the_error_is_the_spread_of_renders(context: Context, name: str) -> None:
    """The test takes the root mean variance of pixels over 64 renders, within 10 %."""
    size: dict[str, Any] = {"width": 24, "height": 24, "sampler": "sobol", "particles": 1.0}
    images = [rendered(ROOMS[name], context, 512, seed=seed, **size, **ON) for seed in range(64)]
    spread = np.var([image.radiance for image in images], axis=0, ddof=1).mean()
    told = np.mean([np.square(image.stderr) for image in images])
    assert 0.9 < (told / spread) ** 0.5 < 1.1


# --- bits ------------------------------------------------------------------------------------


def picture(context: Context, samples: int = 40, **more: Any) -> Image:
    options: dict[str, Any] = {"sampler": "sobol", "bounces": 4, **more}
    return rendered(ROOMS["a lens"], context, samples, **ON, **options)


def test_the_same_bits_every_time(context: Context) -> None:
    assert same(picture(context), picture(context))
    assert not same(picture(context), picture(context, seed=1))


def test_a_crop_is_that_part_of_the_frame(context: Context) -> None:
    part = picture(context, crop=(3, 5, 9, 7))
    whole = picture(context)
    assert same_bits(part.radiance, whole.radiance[5:12, 3:12])
    assert same_bits(part.stderr, whole.stderr[5:12, 3:12])


def test_dispatches_may_be_of_any_size(context: Context, monkeypatch: pytest.MonkeyPatch) -> None:
    expected = picture(context)
    plain = Schedule.next_dispatch

    def small(self: Any, remaining: int, *rest: Any) -> Any:
        return plain(self, min(remaining, 3), *rest)._replace(tiles=1)

    monkeypatch.setattr(Schedule, "next_dispatch", small)
    assert same(picture(context), expected)


def test_shapes_written_into_the_kernel_change_nothing(context: Context) -> None:
    images = []
    for tier in ("generic", "complete"):
        renderer = Renderer(
            ROOMS["a lens"], None, context, tier, width=16, height=16, samples=32, **ON
        )
        images.append(renderer.render().image())
        renderer.release()
    assert same(*images)


def test_light_twice_as_bright_gives_twice_the_radiance(context: Context) -> None:
    """Bit for bit: what particles add is rounded to a unit that grows with the lamps."""
    bright = {**MATERIALS, "lamp": lamp(24.0)}
    scenes = [
        scene_of([*box_of_quads("matte"), LAMP, BALL], kinds, CAMERA)
        for kinds in (MATERIALS, bright)
    ]
    once, twice = (rendered(scene, context, 32, **ON) for scene in scenes)
    assert same_bits(2 * once.radiance, twice.radiance)


def test_sums_need_both_of_their_words(context: Context, monkeypatch: pytest.MonkeyPatch) -> None:
    """Units are so coarse that one word holds all, or so fine that a splat takes thousands."""
    found = {}
    for bits in (20, 40, 50):
        monkeypatch.setattr(particles, "UNIT_BITS", bits)
        found[bits] = picture(context, particles=4.0).radiance.astype(np.float64)
    np.testing.assert_allclose(found[40], found[50], rtol=1e-6)
    np.testing.assert_allclose(found[20], found[50], rtol=2e-4)


def test_light_beyond_a_sum_is_cut_and_reported(
    context: Context, monkeypatch: pytest.MonkeyPatch
) -> None:
    expected = picture(context)
    monkeypatch.setattr(particles, "UNIT_BITS", 70)
    with rendering(ROOMS["a lens"], context, sampler="sobol", bounces=4, **ON) as renderer:
        image = renderer.render(40).image()
        assert renderer.lost_particles.clipped > 10
    assert image.radiance.mean() < expected.radiance.mean()
    assert np.isfinite(image.radiance).all()


def test_a_cut_is_reported_by_the_command(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Any
) -> None:
    monkeypatch.setattr(particles, "UNIT_BITS", 66)
    words = ["--caustics", "on", "--width", "24", "--height", "24", "--samples", "16"]
    assert main(["render", "cornell", *words, "-o", str(tmp_path / "a.png")]) == 0
    assert "brought more light than a pixel takes at once" in capsys.readouterr().err


def test_the_display_pass_shows_them(context: Context) -> None:
    with rendering(ROOMS["a ball of glass"], context, **ON, particles=4.0) as renderer:
        shown = renderer.render(32).display()
        expected = expose_and_encode(renderer.image().radiance, 0.0, "neutral")
    assert np.abs(shown.astype(int) - expected.astype(int)).max() <= 1


def test_a_picture_that_goes_on_has_all_its_particles(context: Context) -> None:
    """Whether it was looked at before or not, and after a restart."""
    with rendering(ROOMS["a lens"], context, sampler="sobol", **ON) as renderer:
        renderer.render(5).image()
        image = renderer.render(40).image()
        renderer.restart()
        again = renderer.render(40).image()
    assert same(image, picture(context, bounces=10))
    assert same(image, again)


@pytest.mark.slow
def test_a_change_of_the_scene_leaves_nothing_behind(context: Context) -> None:
    first, second = ROOMS["a lens"], ROOMS["tinted glass"]
    expected = rendered(second, context, 20, **ON)
    with rendering(first, context, **ON) as renderer:
        renderer.render(7)
        renderer.update(second)
        assert same(renderer.render(20).image(), expected)


def test_rays_lost_to_the_loop_limit_are_followed_again(
    context: Context, monkeypatch: pytest.MonkeyPatch
) -> None:
    """They are followed in smaller parts, to the same bits."""
    expected = picture(context)
    with rendering(ROOMS["a lens"], context, sampler="sobol", bounces=4, **ON) as renderer:
        tracer = renderer._tracer.particles
        assert tracer
        sizes = [0]
        plain = ParticleTracer._dispatch

        def dispatch(self: ParticleTracer, kernel: Any, part: DispatchRange) -> None:
            sizes.append(part.samples)
            plain(self, kernel, part)

        lost = iter([True, True])  # of two dispatches that can be made smaller
        monkeypatch.setattr(ParticleTracer, "_dispatch", dispatch)
        monkeypatch.setattr(tracer, "_rounds", 1 << 16)
        monkeypatch.setattr(DeviceScene, "lost_any", lambda _: sizes[-1] > 1 and next(lost, False))
        assert same(renderer.render(40).image(), expected)
        assert next(lost, None) is None


@pytest.mark.slow
def test_a_picture_too_large_for_the_driver_is_refused(
    context: Context, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(particle_tracer, "PIXEL", 1 << 30)
    with pytest.raises(RenderError, match="no room for the particles of 16 x 16 pixels"):
        rendered(ROOMS["a lens"], context, 1, **ON)


@pytest.mark.slow
def test_cornell_keeps_its_light(context: Context) -> None:
    size: dict[str, Any] = {"width": 32, "height": 32, "sampler": "sobol"}
    one = rendered(load("cornell"), context, 2048, seed=1, **size)
    other = rendered(load("cornell"), context, 512, **size, **ON)
    assert_agree(other, one, within=0.02)
