"""The WGSL version and the GLSL version compute the same picture, stage by stage and bit by bit."""

import pytest

from glrt.context import Context
from glrt.image import Image
from glrt.library import load
from glrt.renderer import Renderer
from glrt.scene import Scene
from tests.mixture import everything
from tests.renders import same
from tests.wgsl.device import Device
from tests.wgsl.program import RayTracer
from tests.wgsl.tracer import Tracer, naive

WIDTH, HEIGHT = 37, 29  # not whole work groups
SCENES = ["cornell", "lamps", "lens", "metals", "sky", "weekend", "mixture"]


@pytest.fixture(scope="session")
def raytracer(webgpu: Device) -> RayTracer:
    return RayTracer(webgpu)


def scene_named(name: str) -> Scene:
    return everything() if name == "mixture" else load(name)


def glsl_image(context: Context, scene: Scene, samples: int) -> Image:
    renderer = Renderer(scene, naive(scene, width=WIDTH, height=HEIGHT), context)
    image = renderer.render(samples).image()
    renderer.release()
    return image


@pytest.mark.parametrize("name", SCENES)
def test_the_picture_is_the_same_to_the_last_bit(
    raytracer: RayTracer, context: Context, name: str
) -> None:
    scene = scene_named(name)
    tracer = Tracer(raytracer, scene, naive(scene, width=WIDTH, height=HEIGHT))
    for samples in (1, 16):
        image = tracer.render(samples).image()
        assert image.radiance.any()
        assert same(image, glsl_image(context, scene, samples)), samples
