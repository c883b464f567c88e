"""The number of rays per sample: a measure of cost that does not depend on the machine."""

from glrt.gpu.context import Context
from glrt.rendering.pipelines import Variant
from glrt.rendering.renderer import Renderer
from glrt.scene.scene import Scene
from glrt.settings import Settings

SAMPLES = 32
COUNTING = Variant({"COUNT_RAYS": True})  # renders the number of rays in place of radiance


def rays_per_sample(scene: Scene, settings: Settings, context: Context) -> float:
    """The mean number of camera, scattered and shadow rays per sample, over the whole frame."""
    counter = Renderer(scene, settings, context, tier="baked", variant=COUNTING)
    mean = float(counter.render(SAMPLES).image().radiance.mean())
    counter.release()
    return mean
