"""The work of a sample, counted: the cost by which methods are chosen, without a clock.

The unit is one round of the loops that find what a ray meets. A kernel that counts rays gives each
ray its weight. The weights are the best predictors of the methods' times on llvmpipe, relative to
`mis`: to 18 % (root mean square) over the methods of 26 scenes; to 40 % over methods with probes in
6 scenes.
"""

from collections.abc import Callable, Iterator
from contextlib import contextmanager

from glrt.analysis.chart.rays import SAMPLES, counting_variant
from glrt.gpu.context import Context
from glrt.gpu.program import TILE, tile_count
from glrt.packing.kernel_structs import CONSTANTS
from glrt.plan.methods import METHODS, reuses_points
from glrt.plan.plan import prepare
from glrt.rendering.probe_tracer import LOOKS, RAYS, UPDATES
from glrt.rendering.renderer import Renderer
from glrt.rendering.schedule import rounds_of_search
from glrt.scene.scene import Scene
from glrt.settings import Settings

SURFACE = 10  # work where a scattered ray meets a surface: position, material, next direction
CAMERA = 6  # work that a camera ray saves there, since camera rays are alike
CLUSTER = 3  # work to weigh a cluster of lamps, or a part of one, for the choice of a lamp
PARTS = 2 * CONSTANTS["PARTS"]  # parts of the chosen cluster, which are weighed for two densities
STRIPS = 5  # work of a point on a quad lamp, uniform in solid angle
LAMP = 2  # work of a lamp in a loop over all lamps, without its shadow ray
LOOKUP = 250  # work of the eight probes around a surface; twice for a gather, whose lanes diverge
RESAMPLED = 600  # work of the points that neighbouring pixels have kept
BLENDED = 500  # work of a ray of an update of light, after the ray: blending it into 64 texels
SEEN = 1100  # the same for distances, into 256 texels

Check = Callable[[Renderer], bool]


@contextmanager
def counting(scene: Scene, settings: Settings, context: Context) -> Iterator[Renderer]:
    """A renderer that returns the weights of the rays of a sample in place of radiance."""
    plan = prepare(scene, settings)
    search, needs = rounds_of_search(plan.facts), plan.needs
    weighed = needs.clusters if needs.clusters > 1 else 0
    choice = CLUSTER * (weighed + PARTS * needs.many_lights)
    is_sampled = METHODS[settings.method].chooses_lights and "quad" in needs.lamps
    strips = STRIPS if is_sampled and not needs.quads_by_area else 0
    lookup = LOOKUP * (1 + METHODS[settings.method].gathers)
    variant = counting_variant(search + SURFACE + choice + strips, search, lookup)
    counter = Renderer(scene, settings, context, tier="complete", variant=variant)
    try:
        yield counter
    finally:
        counter.release()


def work_per_sample(counter: Renderer, bounces: int, check: Check) -> float:
    """The work of a sample by a renderer of `counting`, on average over its frame.

    `check` is called after each dispatch and may raise to stop.
    """
    counter.update(bounces=bounces)
    weights = float(counter.render(SAMPLES, check).image().radiance.mean(dtype=float))
    traits = METHODS[counter.settings.method]
    loops_over_lamps = bool(traits.model) and not traits.chooses_lights
    lamps = counter.plan.facts.sampled_lamps if loops_over_lamps else 0
    points = RESAMPLED * reuses_points(counter.settings)
    return weights - CAMERA + LAMP * lamps + points


def work_of_probes(counter: Renderer) -> tuple[float, float]:
    """Work of a set of probes, and work once for a picture: the same for any number of pixels."""
    probes = counter.probes.tracer
    if not probes:
        return 0.0, 0.0
    with counter.context.gl:
        of_set, once = probes.count()
    rays = RAYS * probes.grid.probes
    return of_set + UPDATES * rays * BLENDED, once + LOOKS * rays * SEEN


def busy_pixels(settings: Settings) -> int:
    """The pixels of the tiles of a frame, those outside it included: they take time as well."""
    return TILE * TILE * tile_count(*settings.size)
