"""The number of rays per sample: a measure of cost that does not depend on the machine."""

from glrt.gpu.context import Context
from glrt.gpu.glsl import read
from glrt.rendering.pipelines import Variant
from glrt.rendering.renderer import Renderer
from glrt.scene.scene import Scene
from glrt.settings import Settings

SAMPLES = 32
COUNTING = Variant({"COUNT_RAYS": True})  # renders the number of rays in place of radiance
_FILE, _COUNT = "shapes/find_hit.glsl", "if (COUNT_RAYS) rays_so_far += 1.0;"


def rays_per_sample(scene: Scene, settings: Settings, context: Context) -> float:
    """The mean number of camera, scattered and shadow rays per sample, over the whole frame."""
    counter = Renderer(scene, settings, context, tier="baked", variant=COUNTING)
    mean = float(counter.render(SAMPLES).image().radiance.mean())
    counter.release()
    return mean


def counting_variant(followed: float, shadow: float) -> Variant:
    """COUNTING with weights: of camera and scattered rays, and of shadow rays."""
    start, middle, end = read(_FILE).split(_COUNT)
    weighed = [f"rays_so_far += {float(weight)!r};" for weight in (followed, shadow)]
    return COUNTING._replace(texts={_FILE: start + weighed[0] + middle + weighed[1] + end})
