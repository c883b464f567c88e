"""Whether the estimated error of a picture of a scene can be believed.

By what its pixels tell (`reliability`), and by what the scene tells: what lamps in view show in
truth (`seen_lamps`).
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
    """Whether the error of a picture, (H, W, 3) each, of so many samples is not to be believed.

    None where that cannot be judged (`is_doubtful`).
    """
    observations = samples // settings.block
    if observations < LEAST_OBSERVATIONS:
        return None
    seen = seen_lamps(scene, settings, radiance, stderr)
    return is_doubtful(radiance, stderr, observations, seen)
