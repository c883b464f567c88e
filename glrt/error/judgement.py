"""Whether the estimated error of a picture of a scene can be believed.

By what its pixels tell (`reliability`), and by what the scene tells: what lamps in view show in
truth (`seen_lamps`), and how bright a sample is that meets a lamp through glass, of which there may
be none yet.
"""

import math

import numpy as np
from numpy.typing import NDArray

from glrt.error.reliability import LEAST_OBSERVATIONS, is_doubtful
from glrt.error.seen_lamps import seen_lamps
from glrt.scene.materials import Lambertian, Principled, glass_of
from glrt.scene.scene import Scene
from glrt.settings import Settings

Pixels = NDArray[np.float32]

ALBEDO = 0.3  # of the surface on which glass gathers light, roughly


def judged(
    scene: Scene, settings: Settings, samples: int, radiance: Pixels, stderr: Pixels
) -> bool | None:
    """Whether the error of a picture, (H, W, 3) each, of so many samples is not to be believed.

    None where that cannot be judged (`is_doubtful`).
    """
    observations = samples // settings.block
    if observations < LEAST_OBSERVATIONS:
        return None
    seen = seen_lamps(scene, settings, radiance, stderr)
    return is_doubtful(radiance, stderr, observations, seen, spark(scene, samples, radiance))


def spark(scene: Scene, samples: int, radiance: Pixels) -> float:
    """How many times as bright as usual a sample makes its pixel that meets a lamp through glass.

    0 in scenes without glass, lamps or matte surfaces; inf where half of the picture is black.
    """
    materials = [scene.materials[shape.material] for shape in scene.visible]
    has_glass = any(glass_of(material) for material in materials)
    has_matte = any(isinstance(material, Lambertian | Principled) for material in materials)
    lamps = [shape for shape in scene.visible if math.isfinite(shape.reach)]
    brightest = max((max(scene.emission_of(lamp)) for lamp in lamps), default=0.0)
    if not has_glass or not has_matte or not brightest:
        return 0.0
    step = max(1, math.isqrt(radiance.size >> 20))
    usual = float(np.median(radiance[::step, ::step]))
    return ALBEDO * brightest / samples / usual if usual > 0 else math.inf
