"""Whether the estimated error of a picture of a scene can be believed.

It is judged by its pixels (`reliability`) and by the scene, which gives the true radiance of lamps
in view (`seen_lamps`).
"""

import numpy as np
from numpy.typing import NDArray

from glrt.error.reliability import LEAST_OBSERVATIONS, is_doubtful
from glrt.error.seen_lamps import seen_lamps
from glrt.scene.scene import Scene
from glrt.settings import Settings

Pixels = NDArray[np.float32]


def judged(
    scene: Scene, settings: Settings, samples: int, radiance: Pixels, stderr: Pixels
) -> bool | None:
    """Whether the error of a picture, (H, W, 3) each, with `samples` per pixel is doubtful.

    None if that cannot be judged (`is_doubtful`).
    """
    observations = settings.division.observations(samples)
    if observations < LEAST_OBSERVATIONS:
        return None
    seen = seen_lamps(scene, settings, radiance, stderr)
    return is_doubtful(radiance, stderr, observations, seen)
