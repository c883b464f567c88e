"""How many rays a sample takes: the cost of a picture on any machine."""

from glrt.analysis.shader_edits import Edit, edited
from glrt.gpu.context import Context
from glrt.scene.scene import Scene
from glrt.settings import Settings

SAMPLES = 32

_COUNTER = """float rays_so_far = 0.0;

vec3 rays_of_sample() {
    vec3 rays = vec3(rays_so_far);
    rays_so_far = 0.0;
    return rays;
}

"""
_COUNTED = "    rays_so_far += 1.0;\n"
_CLOSEST = "Hit closest_hit(Ray ray) {\n"
_SHADOW = "bool occluded(Ray ray, float limit, int ignored) {\n"

# Renders rays a sample where another renderer renders radiance.
RayCounter = edited(
    Edit("shape.glsl", _CLOSEST, _COUNTER + _CLOSEST + _COUNTED),
    Edit("shape.glsl", _SHADOW, _SHADOW + _COUNTED),
    Edit("samples.glsl", "path.radiance", "rays_of_sample()"),
)


def rays_per_sample(scene: Scene, settings: Settings, context: Context) -> float:
    """The mean over the frame: camera, scattered and shadow rays."""
    counter = RayCounter(scene, settings, context, tier="baked")
    mean = float(counter.render(SAMPLES).image().radiance.mean())
    counter.release()
    return mean
