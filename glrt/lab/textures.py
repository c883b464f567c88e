"""Images on surfaces: coordinates far from the image, bent normals, and layers full of holes."""

import math
from typing import Any

import numpy as np

from glrt.gpu.glsl import read
from glrt.lab.scenes import lamp, plane, quad, scene_of
from glrt.lab.sweep import SIGMAS, Lab, Sweep, mean_of
from glrt.rendering.pipelines import Variant
from glrt.scene.materials.base import Opaque
from glrt.scene.scene import Scene

_NUMBERS = "sampling/hole_numbers.glsl"
ALPHA = 0.02  # of a layer
ROUNDING = 2.0**-24  # half a step of a float, relative


def layers(lab: Lab) -> Sweep:
    """Error of the light behind layers that are there in part, against (1 - alpha)^n."""
    x = [1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0]
    text = read(_NUMBERS)
    known = text.replace("hole_key + passed", "hole_key")
    variants = {"glrt": Variant(), "one number for all layers": Variant(texts={_NUMBERS: known})}
    errors: dict[str, list[float]] = {name: [] for name in variants}
    bound = []
    for count in x:
        scene = thin_layers(int(count))
        left = (1 - ALPHA) ** count
        for name, variant in variants.items():
            image = lab.render(scene, lab.count(512, 64), variant, width=8, height=8, bounces=0)
            mean, noise = mean_of(image)
            errors[name].append(abs(mean / left - 1))
            if name == "glrt":
                bound.append(max(SIGMAS * noise / left, 1e-6))
    first, *others = errors.items()
    return Sweep(
        parameter=f"layers of alpha {ALPHA}",
        measure="relative error of the light behind them",
        x=x,
        chosen=first,
        others=dict(others),
        promise="within the noise",
        bound=bound,
    )


def thin_layers(count: int) -> Scene:
    """Return layers of alpha ALPHA in front of a wall that emits 1."""
    black = {"type": "principled", "color": [0.0] * 3, "specular": 0.0, "alpha": ALPHA}
    heights = np.linspace(-1, -2, count).tolist()
    sheets = [quad([-50, -50, z], [100, 0, 0], [0, 100, 0], "p") for z in heights]
    wall = plane([0, 0, -3], [0, 0, 1], "lamp")
    return scene_of([*sheets, wall], {"p": black, "lamp": lamp(1.0)})


def far(lab: Lab) -> Sweep:
    """Error of the place in an image, at coordinates far from 0 to 1."""
    x = [float(2**power) for power in range(0, 25, 3)]
    rng = np.random.default_rng(1)
    shares = rng.uniform(0, 1, lab.count(1 << 14, 1 << 10))
    errors = []
    for offset in x:
        place = lab.path("within(place, REPEAT)", {"place": shares + offset}).astype(np.float64)
        aside = np.abs(place - shares)
        errors.append(float(np.minimum(aside, 1 - aside).max()))
    return Sweep(
        parameter="distance of the coordinates from 0",
        measure="error of the place\n(widths of the image)",
        x=x,
        chosen=("glrt", errors),
        others={"a pixel of 1,024": [1 / 1024] * len(x)},
        promise="at most the step of a float there",
        bound=[2 * ROUNDING * (offset + 2) for offset in x],
    )


def bumps(lab: Lab) -> Sweep:
    """Light that a white surface with a bent normal keeps, seen head-on in a white surrounding.

    What a lobe about the normal sends into the surface is lost, (1 - cos) / 2; beyond 45 degrees
    the surface's own normal counts, as the view mirrored at the bent one would lead into it.
    """
    x = [0.5, 2.0, 5.0, 10.0, 20.0, 30.0, 40.0, 44.0, 46.0, 60.0, 80.0, 89.0]
    errors, lost, bound = [], [], []
    for degrees in x:
        scene = _bent(math.radians(degrees))
        settings: dict[str, Any] = {"width": 1, "height": 1, "roulette": False}
        image = lab.render(scene, lab.count(1 << 16, 1 << 12), **settings)
        mean, noise = mean_of(image)
        truth = (1 - math.cos(math.radians(degrees))) / 2 if degrees < 45 else 0.0
        lost.append(max(1 - mean, 1e-6))
        errors.append(abs(1 - mean - truth))
        bound.append(SIGMAS * noise + 5e-4)  # a half float of the normal
    return Sweep(
        parameter="inclination of the normal, degrees",
        measure="light lost against (1 - cos) / 2\n(share)",
        x=x,
        chosen=("glrt: error", errors),
        others={"light that is lost": lost},
        promise="within the noise, and no light is gained",
        bound=bound,
    )


def _bent(angle: float) -> Scene:
    texture = {"image": "normal", "filter": "nearest"}
    white = {"type": "principled", "color": [1.0] * 3, "specular": 0.0, "normal": texture}
    scene = scene_of(
        [quad([-1, 1, -1], [2, 0, 0], [0, -2, 0], "m")],
        {"m": white},
        {"fov": 0.1},
        background={"color": [1.0] * 3},
    )
    normal = np.array([math.sin(angle), 0.0, math.cos(angle)])
    texels = np.ones((1, 1, 4), np.float16)
    texels[..., :3] = (normal + 1) / 2
    material = scene.materials["m"]
    assert isinstance(material, Opaque)
    (found,) = material.textures.values()
    assert found.image
    known = {found.image: found.image.read_as(f"{angle:.6f}", texels, None)}
    return scene.model_copy(update={"materials": {"m": material.with_images(known)}})
