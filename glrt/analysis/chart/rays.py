"""The number of rays per sample: a measure of cost that does not depend on the machine."""

from glrt.gpu.context import Context
from glrt.gpu.glsl import read
from glrt.rendering.pipelines import Variant
from glrt.rendering.renderer import Renderer
from glrt.scene.scene import Scene
from glrt.settings import Settings

SAMPLES = 32
COUNTING = Variant({"COUNT_RAYS": True})  # renders the number of rays in place of radiance
_FOLLOWED, _SHADOW = "shapes/find_hit.glsl", "textures/holes.glsl"
_COUNT = "if (COUNT_RAYS) rays_so_far += 1.0;"


def rays_per_sample(scene: Scene, settings: Settings, context: Context) -> float:
    """The mean number of camera, scattered and shadow rays per sample, over the whole frame."""
    counter = Renderer(scene, settings, context, tier="baked", variant=COUNTING)
    mean = float(counter.render(SAMPLES).image().radiance.mean())
    counter.release()
    return mean


def counting_variant(followed: float, shadow: float) -> Variant:
    """COUNTING with weights: of camera and scattered rays, and of shadow rays."""
    texts = {}
    for file, weight in ((_FOLLOWED, followed), (_SHADOW, shadow)):
        start, end = read(file).split(_COUNT)
        texts[file] = f"{start}rays_so_far += {float(weight)!r};{end}"
    return COUNTING._replace(texts=texts)
