"""How many rays a sample takes: the cost of a picture on any machine."""

from glrt.gpu.context import Context
from glrt.rendering.pipelines import Variant
from glrt.rendering.renderer import Renderer
from glrt.scene.scene import Scene
from glrt.settings import Settings

SAMPLES = 32
COUNTING = Variant({"COUNT_RAYS": True})  # rays a sample in place of radiance


def rays_per_sample(scene: Scene, settings: Settings, context: Context) -> float:
    """The mean over the frame: camera, scattered and shadow rays."""
    counter = Renderer(scene, settings, context, tier="baked", variant=COUNTING)
    mean = float(counter.render(SAMPLES).image().radiance.mean())
    counter.release()
    return mean
