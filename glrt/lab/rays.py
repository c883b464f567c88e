"""How many rays a sample takes: the cost of a picture on any machine."""

from glrt.context import Context
from glrt.renderer import Renderer
from glrt.scene import Scene
from glrt.settings import Settings
from glrt.shader import read

SAMPLES = 32

_COUNTER = """float rays_so_far = 0.0;

vec3 rays_of_sample() {
    vec3 rays = vec3(rays_so_far);
    rays_so_far = 0.0;
    return rays;
}

"""
_SEARCHES = (
    "Hit closest_hit(Ray ray) {\n",
    "bool occluded(Ray ray, float limit, int ignored) {\n",
)


class RayCounter(Renderer):
    """Renders rays a sample where another renderer renders radiance."""

    def _parts(self) -> dict[str, str]:
        searches = read("shape.glsl")
        for head in _SEARCHES:
            searches = _replaced(searches, head, f"{head}    rays_so_far += 1.0;\n")
        samples = _replaced(read("samples.glsl"), "path.radiance", "rays_of_sample()")
        counting = {"shape.glsl": _COUNTER + searches, "samples.glsl": samples}
        return {**super()._parts(), **counting}


def rays_per_sample(scene: Scene, settings: Settings, context: Context) -> float:
    """The mean over the frame: camera, scattered and shadow rays."""
    counter = RayCounter(scene, settings, context, tier="baked")
    mean = float(counter.render(SAMPLES).image().radiance.mean())
    counter.release()
    return mean


def _replaced(text: str, old: str, new: str) -> str:
    if text.count(old) != 1:
        raise KeyError(f"the shaders hold `{old.strip()}` {text.count(old)} times, not once")
    return text.replace(old, new)
