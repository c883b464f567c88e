"""The WGSL version and the GLSL version compute the same picture, stage by stage and bit by bit.

So on software drivers. On a GPU, OpenGL and Vulkan may round otherwise, within a tolerance.

Each fault planted into one of them shows in the stages where it must, and in no other.
"""

from ctypes.util import find_library
from functools import cache
from typing import get_args

import pytest

from glrt.gpu.context import Context
from glrt.image.sources import load
from glrt.rendering.renderer import Renderer
from glrt.scene.scene import Scene
from glrt.settings import Settings, ToneMap
from tests.support.builders import scene_of, sphere
from tests.support.mixed_scene import MATERIALS, everything
from tests.support.system_packages import needs_osmesa, needs_package
from tests.wgsl import table
from tests.wgsl.crosscheck import (
    FRAMES,
    Array,
    Record,
    WgslVersion,
    agreements,
    flipped,
    glsl_record,
    relative_rms,
)
from tests.wgsl.device import Device, is_software
from tests.wgsl.display import DisplayPass
from tests.wgsl.program import RayTracer
from tests.wgsl.text import Fault, joined, planted
from tests.wgsl.tracer import Tracer, naive

WIDTH, HEIGHT = 37, 29  # not whole work groups
SCENES = ["cornell", "lamps", "lens", "metals", "sky", "weekend", "mixture"]


class Unswapped(Tracer):
    """Reads the texture that it never writes."""

    def swap(self) -> None:
        pass


DRAWS, RAY, HIT, SCATTERING = "draws", "ray", "hit", "scattering"
ONE, MANY, DISPLAY = "1 sample", "16 samples", "display"
IMAGES = {ONE, MANY, DISPLAY}
FAULTS = {
    "another seed": (
        Fault("rng", "return Sampler(seed, 0u)", "return Sampler(seed + 1u, 0u)"),
        {DRAWS, RAY, HIT, SCATTERING, *IMAGES},
    ),
    "square pixels stretched": (
        Fault("camera", "- 1.0) * camera.tan_x", "- 1.0) * camera.tan_y"),
        {DRAWS, RAY, HIT, SCATTERING, *IMAGES},
    ),
    "the other root": (
        Fault("shape", "return select(q, t, t > 0.0)", "return select(t, q, t > 0.0)"),
        {DRAWS, HIT, SCATTERING, *IMAGES},
    ),
    "a normal flipped inside glass": (
        Fault("path", "frame_around(side * surface.normal)", "frame_around(surface.normal)"),
        {DRAWS, SCATTERING, *IMAGES},
    ),
    "one bounce too many": (
        Fault("path", "if ((*path).depth == settings", "if ((*path).depth > settings"),
        {DRAWS, *IMAGES},
    ),
    "a mean by mix": (
        Fault(
            "film",
            "return exact3(mean + exact3(change + dither));",
            "return mix(mean, x, vec3f(weight));",
        ),
        {MANY},
    ),
    "an sRGB curve of 2.2": (
        Fault(
            "tonemap",
            "let curved = 1.055 * pow(linear_, vec3f(1.0 / 2.4)) - 0.055;",
            "let curved = pow(linear_, vec3f(1.0 / 2.2));",
        ),
        {DISPLAY},
    ),
}


DOT = "exact(a.x * b.x) + exact(exact(a.y * b.y) + exact(a.z * b.z))"
OTHER_DOT = "exact(exact(a.x * b.x) + exact(a.y * b.y)) + exact(a.z * b.z)"
ROUNDINGS = {
    "another order of sums": (Fault("exact", DOT, OTHER_DOT), True),
    "one bounce too many": (FAULTS["one bounce too many"][0], False),
    "another seed": (FAULTS["another seed"][0], False),
}


@pytest.fixture(scope="session")
def wgsl(webgpu: Device) -> WgslVersion:
    return WgslVersion(webgpu)


@cache
def scene_named(name: str) -> Scene:
    if name == "mixture":
        return everything()
    if name == "inside glass":
        objects = [
            sphere([0.2, 0.1, -0.3], 1.0, "glass"),
            sphere([0, 0, 0], 5.0, "white"),
            sphere([1, 2, -3], 0.8, "lamp"),
        ]
        return scene_of(objects, MATERIALS, render={"bounces": 3})
    return load(name)


def settings_of(scene: Scene, **more: int) -> Settings:
    return naive(scene, None, width=WIDTH, height=HEIGHT, **more)


def other_seed(context: Context, scene: Scene, settings: Settings) -> Array:
    """The picture of the last frame, of other random numbers."""
    renderer = Renderer(scene, settings, context, seed=settings.seed + 1)
    radiance = renderer.render(FRAMES).image().radiance
    renderer.release()
    return radiance


def is_the_same_except_for_rounding(one: Record, other: Record, independent: Array) -> bool:
    """The agreement two drivers must reach: few paths take another branch, the same noise."""
    few = flipped(one[ONE][0], other[ONE][0]) <= 0.0005
    return few and relative_rms(one[MANY][0], other[MANY][0], independent) <= 0.01


def differing(one: Record, other: Record) -> set[str]:
    return {stage for stage, identical, _ in agreements(one, other) if identical < 1}


@pytest.mark.slow
@pytest.mark.parametrize("name", SCENES)
def test_both_versions_show_the_same(
    webgpu: Device, wgsl: WgslVersion, context: Context, name: str
) -> None:
    scene = scene_named(name)
    settings = settings_of(scene)
    record, kernel = wgsl.record(scene, settings), glsl_record(context, scene, settings)
    assert len({pixel.tobytes() for pixel in record[MANY][0].reshape(-1, 3)}) > 100
    if context.is_software and is_software(webgpu):
        assert [each for each in agreements(record, kernel) if each.identical < 1] == []
    else:
        assert is_the_same_except_for_rounding(record, kernel, other_seed(context, scene, settings))


@pytest.mark.parametrize("name", ROUNDINGS)
def test_on_a_gpu_rounding_passes_and_nothing_else(
    webgpu: Device, context: Context, name: str
) -> None:
    fault, passes = ROUNDINGS[name]
    scene = scene_named("mixture")
    settings = settings_of(scene, bounces=2)
    record = WgslVersion(webgpu, fault).record(scene, settings)
    kernel = glsl_record(context, scene, settings)
    assert differing(record, kernel) >= {ONE, MANY}
    independent = other_seed(context, scene, settings)
    assert is_the_same_except_for_rounding(record, kernel, independent) == passes


def shows_in(stages: set[str], found: set[str], context: Context, webgpu: Device) -> bool:
    """Whether these stages differ, and on a processor, where all bits are equal, no other."""
    if context.is_software and is_software(webgpu):
        return found == stages
    return found >= stages


@pytest.fixture(scope="session")
def glass_record(context: Context) -> Record:
    """The camera stands in a glass ball, the ball in a white one with a lamp."""
    scene = scene_named("inside glass")
    return glsl_record(context, scene, settings_of(scene))


@pytest.mark.slow_cases("another seed")
@pytest.mark.parametrize("name", FAULTS)
def test_a_planted_fault_shows_in_the_stages_where_it_must(
    webgpu: Device, context: Context, glass_record: Record, name: str
) -> None:
    fault, stages = FAULTS[name]
    scene = scene_named("inside glass")
    record = WgslVersion(webgpu, fault).record(scene, settings_of(scene))
    assert shows_in(stages, differing(record, glass_record), context, webgpu)


def test_ping_pong_that_is_not_swapped_shows_in_the_second_frame(
    webgpu: Device, context: Context, glass_record: Record
) -> None:
    scene = scene_named("inside glass")
    record = WgslVersion(webgpu, tracer=Unswapped).record(scene, settings_of(scene))
    assert shows_in({MANY, DISPLAY}, differing(record, glass_record), context, webgpu)


def test_a_fault_that_cannot_be_planted_is_an_error() -> None:
    with pytest.raises(LookupError, match="0 times"):
        planted("a = b;", "a = c", "a = d")
    with pytest.raises(LookupError, match="2 times"):
        planted("a = b; a = b;", "a = b", "a = d")
    with pytest.raises(LookupError, match="no file nowhere"):
        joined(("exact",), Fault("nowhere", "a", "b"))


@pytest.mark.parametrize("tonemap", get_args(ToneMap))
@pytest.mark.parametrize("exposure", [-2.0, 1.5])
def test_every_tone_curve_shows_the_same_colours(
    webgpu: Device, context: Context, tonemap: ToneMap, exposure: float
) -> None:
    scene = scene_named("mixture")
    settings = naive(scene, settings_of(scene), tonemap=tonemap, exposure=exposure)
    tracer = Tracer(RayTracer(webgpu), scene, settings).render(4)
    renderer = Renderer(scene, settings, context)
    shown = renderer.render(4).display().astype(int)
    renderer.release()
    apart = abs(DisplayPass(webgpu).codes(tracer.picture, settings).astype(int) - shown)
    assert apart.max() <= (0 if context.is_software and is_software(webgpu) else 1)
    assert len({tuple(pixel) for pixel in shown.reshape(-1, 3)}) > 100


def test_the_table_of_the_cross_check_can_be_made_again(
    webgpu: Device, capsys: pytest.CaptureFixture[str]
) -> None:
    needs_package(bool(find_library("EGL")), "libegl1")
    needs_osmesa()
    assert table.main(["--size", "8", "--scenes", "lamps"]) == 0
    printed = capsys.readouterr().out
    assert printed.count("| lamps | ") == 3
    assert printed.count("| scene | draws | ray | hit | scattering | 1 sample ") == 3
