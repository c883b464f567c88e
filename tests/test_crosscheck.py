"""The WGSL version and the GLSL version compute the same picture, stage by stage and bit by bit.

Each fault planted into one of them shows in the stages where it must, and in no other.
"""

from functools import cache

import pytest

from glrt.context import Context
from glrt.library import load
from glrt.scene import Scene
from glrt.settings import Settings
from tests.builders import scene_of, sphere
from tests.mixture import MATERIALS, everything
from tests.wgsl.crosscheck import Record, WgslVersion, agreements, glsl_record
from tests.wgsl.device import Device
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


def differing(one: Record, other: Record) -> set[str]:
    return {stage for stage, identical, _ in agreements(one, other) if identical < 1}


@pytest.mark.parametrize("name", SCENES)
def test_every_stage_is_the_same_to_the_last_bit(
    wgsl: WgslVersion, context: Context, name: str
) -> None:
    scene = scene_named(name)
    settings = settings_of(scene)
    record = wgsl.record(scene, settings)
    assert len({pixel.tobytes() for pixel in record[MANY][0].reshape(-1, 3)}) > 100
    found = list(agreements(record, glsl_record(context, scene, settings)))
    assert [each for each in found if each.identical < 1 or each.distance] == []


@pytest.fixture(scope="session")
def glass_record(context: Context) -> Record:
    """The camera stands in a glass ball, the ball in a white one with a lamp."""
    scene = scene_named("inside glass")
    return glsl_record(context, scene, settings_of(scene))


@pytest.mark.parametrize("name", FAULTS)
def test_a_planted_fault_shows_in_the_stages_where_it_must(
    webgpu: Device, glass_record: Record, name: str
) -> None:
    fault, stages = FAULTS[name]
    scene = scene_named("inside glass")
    record = WgslVersion(webgpu, fault).record(scene, settings_of(scene))
    assert differing(record, glass_record) == stages


def test_ping_pong_that_is_not_swapped_shows_in_the_second_frame(
    webgpu: Device, glass_record: Record
) -> None:
    scene = scene_named("inside glass")
    record = WgslVersion(webgpu, tracer=Unswapped).record(scene, settings_of(scene))
    assert differing(record, glass_record) == {MANY, DISPLAY}


def test_a_fault_that_cannot_be_planted_is_an_error() -> None:
    with pytest.raises(LookupError, match="0 times"):
        planted("a = b;", "a = c", "a = d")
    with pytest.raises(LookupError, match="2 times"):
        planted("a = b; a = b;", "a = b", "a = d")
    with pytest.raises(LookupError, match="no file nowhere"):
        joined(("exact",), Fault("nowhere", "a", "b"))
