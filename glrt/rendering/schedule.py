"""Plan the work of each dispatch, within the driver's loop limit and a budget of time.

A frame gives every pixel some samples. If a whole frame takes too long, each dispatch covers a part
of the picture: tiles of 8 x 8 pixels, one work group each. The tiles of one dispatch lie all over
the picture, so that all parts cost about the same. The more samples a picture has, the more a frame
adds, since many samples cost less together.
"""

import math
from itertools import count
from typing import NamedTuple

from glrt.core.errors import SceneError
from glrt.gpu.context import Context
from glrt.gpu.driver_checks import usable_rounds
from glrt.gpu.glsl import read
from glrt.gpu.program import Pace
from glrt.gpu.structs import read_constants
from glrt.packing.kernel_structs import CONSTANTS
from glrt.plan.case import has_image
from glrt.plan.facts import MESH, SceneFacts
from glrt.plan.features import NEAR
from glrt.plan.methods import METHODS, SPATIAL, TEMPORAL, depth_of, reuses_points
from glrt.plan.plan import Plan
from glrt.scene.loading.scene_files import check_loaded
from glrt.scene.scene import Scene
from glrt.settings import RenderSettings

MOST_TILES = 65_535  # work groups of a dispatch that every OpenGL grants
FIRST_TILES = 16  # tiles of the first dispatch, whose cost is not known
TREE_ROUNDS = 8  # rounds of a ray in a tree over n spheres, times log2(n): docs/results/speed.md
PARTS = CONSTANTS["PARTS"]  # parts of a cluster of lamps
GROWTH = 4  # largest factor of the work from one dispatch to the next
MOST_TOGETHER = 16  # samples of a frame: more are hardly faster (docs/results/design-choices.md)
# The two powers of a highlight, by squaring: a round for each bit, and the last check.
_EXPONENT = read_constants(read("integrators/classic.glsl"))["MOST_EXPONENT"]
HIGHLIGHT_ROUNDS = 2 * (_EXPONENT.bit_length() + 1)
LINK_ROUNDS = read_constants(read("integrators/sphere_links.glsl"))["ROUNDS"]
MOST_PASSED = 8
ENOUGH = 0.75  # share of a budget of time: the rest is not worth another dispatch
_GOLDEN = 0.618


class DispatchPolicy(NamedTuple):
    """Limits of dispatches and frames, after which a render can stop or show its picture."""

    limit: float  # seconds that no dispatch may exceed: drivers end those of some seconds
    share: float  # largest frame, in samples of the picture; an early end loses it
    patience: float  # seconds that a frame may take, unless a single sample takes longer


# Dispatches are planned for half of their limit. In a window only edits end a frame early. They
# restart the picture anyway, so nothing is lost.
HEADLESS = DispatchPolicy(0.5, 1 / 8, math.inf)
INTERACTIVE = DispatchPolicy(0.1, 1 / 4, 1.0)


def iterations_per_sample(plan: Plan, tree_rounds: float = TREE_ROUNDS) -> int:
    """Rounds of all loops for one sample: each segment runs over the shapes, once or twice.

    An upper bound; with a tree over the spheres an estimate, and with `tree_rounds` of 0 a lower
    bound. Lamps are weighed twice: for their sum, and to choose one. That loop takes a round less
    than others. Many lamps form clusters, whose parts are weighed likewise. They are weighed again
    for the density of the lamp that is sampled, and of the lamp that is met.
    """
    facts, settings = plan.facts, plan.settings
    search = rounds_of_search(facts, tree_rounds)
    traits = METHODS[settings.method]
    if traits.model and not traits.chooses_lights:
        return 1 + _rounds_of_shading(facts, settings, search)
    rays, choice = (2, _rounds_of_choice(facts)) if traits.uses_lamps else (1, 0)
    if traits.samples_lights and (levels := _levels_of_sky(plan.scene)):
        rays, choice = rays + 1, choice + levels + 1
    rays += traits.samples_lights and plan.scene.sun is not None
    segments = (settings.bounces + 1) * (1 + _passed(facts))
    bounds = facts.media.rounds_of_bounds if plan.needs.has_media else 0
    if plan.needs.has_grid and tree_rounds:
        bounds += facts.media.steps(settings.march_step if plan.needs.marches else None)
    if plan.needs.has_equiangular:  # a ray more, and its lamp chosen
        rays, choice = rays + 1, 2 * choice + 2 * facts.clusters
    return 1 + segments * (1 + rays * (search + bounds) + choice)


def rounds_for_particles(plan: Plan) -> int:
    """Additional rounds: weights of paths against particles, and links to the camera."""
    settings, particles = plan.settings, plan.facts.particles
    if settings.caustics == "off":
        return 0
    spheres = 1 + plan.facts.shapes["sphere"]
    # Light that a segment meets is weighed, and a sample of each kind of light.
    far = (plan.scene.sun is not None) + particles.sky_sends
    balls = spheres * bool(particles.casters) + len(particles.targets) + bool(particles.targets)
    weighed = (1 + far + bool(particles.lamps)) * balls if settings.aimed else 0
    begun = bool(far) * (1 + plan.facts.shapes["plane"])  # before the planes on its way
    search = rounds_of_search(plan.facts)
    links = 2 + LINK_ROUNDS + spheres + 2 * search if settings.linked and particles.links else 0
    start = 3 + plan.facts.clusters + 2 * balls + search + begun
    return (settings.bounces + 1) * (weighed + begun + links) + start + links


def rounds_for_reuse(plan: Plan) -> int:
    """Additional rounds for points that other samples have kept: one ray to each."""
    reuse = plan.settings.reuse
    if not reuses_points(plan.settings):
        return 0
    asked = 1 + (reuse in TEMPORAL) + NEAR * (reuse in SPATIAL)
    return 2 * asked + asked * rounds_of_search(plan.facts)


def _levels_of_sky(scene: Scene) -> int:
    """Levels of the tree that samples an image of the sky; 0 without an image."""
    picture = scene.sky
    if not has_image(scene) or picture is None or picture.pixels is None:
        return 0
    height, width, _ = picture.pixels.shape
    return int(max(width, height + 1) - 1).bit_length()


def _passed(facts: SceneFacts) -> int:
    """Holes, and surfaces in other glass, that a segment may pass; a guess from MOST_PASSED on."""
    passed = {*facts.nested, *facts.lobes.passed, *facts.media.displaced}
    shapes = facts.scene.visible if passed else ()
    return min(sum(thing.material in passed for thing in shapes), MOST_PASSED)


def rounds_of_search(facts: SceneFacts, tree_rounds: float = TREE_ROUNDS) -> int:
    """Rounds of the loops that find what one ray meets.

    A loop over n shapes of one kind takes n + 1 rounds: the last one finds the end. With a tree the
    number is an estimate.
    """
    in_trees = [*facts.tree_kinds, *(["sphere"] if facts.has_sphere_tree else [])]
    counts = [
        facts.count_of(facts.tree_kinds) + len(facts.instances) + facts.triangles,
        facts.has_sphere_tree * facts.shapes["sphere"],
    ]
    by_tree = sum(round(tree_rounds * math.log2(count)) for count in counts if count)
    in_trees.append(MESH)
    single = [count for kind, count in facts.shapes.items() if count and kind not in in_trees]
    return sum(single) + len(single) + by_tree


def _rounds_of_choice(found: SceneFacts) -> int:
    parts = 4 * PARTS + 2 if found.has_many_lights else 0
    return 2 * found.clusters + parts


def _rounds_of_shading(found: SceneFacts, settings: RenderSettings, search: int) -> int:
    """Rounds of a lighting model: its segments, and a shadow ray or a highlight for each lamp."""
    lamps = sum(found.lamps.values())
    traits = METHODS[settings.method]
    if not traits.follows:
        highlights = 4 if settings.phong else 1  # the material's and the own one, again for terms
        return 1 + search + lamps * (1 + highlights * HIGHLIGHT_ROUNDS)
    ends, segments = 1, settings.bounces + 1
    if traits.splits and (found.solid_glasses or found.panes):
        ends = 1 << depth_of(settings)  # light is gathered where a path ends
        segments = 2 * ends
    return (segments + ends * lamps) * (1 + search)


def dispatch_limits(context: Context, plan: Plan) -> tuple[int | None, int]:
    """Loop rounds per dispatch (None: no limit), and the most samples per dispatch.

    Raises SceneError if not even one sample fits, or for a scene whose files were not read.
    """
    check_loaded(plan.scene)
    more = _more_rounds(plan)
    iterations = iterations_per_sample(plan) + more
    rounds = usable_rounds(context)
    least = iterations_per_sample(plan, 0) + more
    return rounds, most_samples(iterations, rounds, least)


def is_within_limit(context: Context, plan: Plan) -> bool:
    """Whether one sample is expected to stay within the driver's loop limit."""
    rounds = usable_rounds(context)
    return rounds is None or iterations_per_sample(plan) + _more_rounds(plan) <= rounds


def _more_rounds(plan: Plan) -> int:
    return rounds_for_particles(plan) + rounds_for_reuse(plan)


def most_samples(iterations: int, rounds: int | None, least: int | None = None) -> int:
    """The most samples in a dispatch of `rounds` loop rounds; SceneError if not even one fits.

    `rounds` is None for a driver that does not limit loops. `least` is the certain number of rounds
    of a sample, if `iterations` is an estimate.
    """
    if rounds is None:
        return 1 << 10
    certain = iterations if least is None else least
    if certain > rounds:
        raise SceneError(
            f"the scene is beyond this driver's loop limit: one sample takes up to "
            f"{certain} rounds of its loops (shapes x bounces), and it stops silently after "
            f"{rounds}, with a wrong image. Use fewer objects, fewer bounces or a GPU."
        )
    return max(1, rounds // iterations)


def stride_of(tiles: int) -> int:
    """Distance in the picture between tiles with neighbouring numbers, along rows of tiles.

    It has no common factor with `tiles`, so `number * stride % tiles` meets each tile once. It is
    small enough for that product in 32 bits.
    """
    start = max(1, min(int(_GOLDEN * tiles), 2**32 // tiles - 64))
    return next(stride for stride in count(start) if math.gcd(stride, tiles) == 1)


class DispatchRange(NamedTuple):
    """The work of one dispatch: `samples` per pixel, in `tiles` tiles from number `first` on."""

    samples: int
    first: int
    tiles: int


def whole_frame(samples: int, tiles: int) -> list[DispatchRange]:
    """Dispatches over all tiles, as few as every driver can take."""
    starts = range(0, tiles, MOST_TILES)
    return [DispatchRange(samples, first, min(MOST_TILES, tiles - first)) for first in starts]


class Schedule:
    """Plans frames dispatch by dispatch, from the times of the dispatches so far."""

    def __init__(self, tiles: int, most_samples: int, rounds: int = 0) -> None:
        """Plan for a picture of `tiles`, `most_samples` a dispatch and loop `rounds` a sample."""
        self._tiles, self._rounds = tiles, rounds
        self._most = most_samples
        self.follow(Pace())

    def follow(self, pace: Pace) -> None:
        """Plan for another program, from the times of its dispatches so far.

        If samples take more rounds now, those times are discarded, and it begins carefully.
        """
        self._pace = pace
        if self._rounds > pace.rounds:
            pace.tried = pace.cost = pace.cost_alone = 0.0
        pace.rounds = self._rounds
        pace.tried = max(pace.tried, FIRST_TILES / GROWTH)
        self.drop()

    @property
    def begun(self) -> float:
        """Samples per pixel in the incomplete frame, on average over the picture."""
        return self._samples * self._done / self._tiles

    def drop(self) -> None:
        """Discard the incomplete frame: the next part starts another one."""
        self._samples = self._done = 0

    def limit(self, most_samples: int) -> None:
        """Begin the frame again, with at most `most_samples` per dispatch."""
        self._most = most_samples
        self.drop()

    def next_dispatch(
        self, remaining: int, seconds: float, held: int = 0, policy: DispatchPolicy = HEADLESS
    ) -> DispatchRange:
        """The next dispatch: at most `remaining` samples per pixel in all, in about `seconds`.

        The picture has `held` samples. `policy` sets the size of a new frame only.
        """
        if self._samples > remaining:
            self.drop()
        if not self._done:
            at_once = self._fitting(seconds, self._pace.cost) / self._tiles
            together = min(held * policy.share, MOST_TOGETHER)
            if self._pace.cost:
                together = min(together, policy.patience / (self._pace.cost * self._tiles))
            self._samples = max(1, min(int(max(at_once, together)), self._most, remaining))
        left = self._tiles - self._done
        is_alone = self._samples == 1 and self._pace.cost_alone
        fitting = self._fitting(seconds, self._pace.cost_alone if is_alone else self._pace.cost)
        most = min(MOST_TILES, max(1, int(fitting / self._samples)))
        dispatches = math.ceil(left / most)
        return DispatchRange(self._samples, self._done, math.ceil(left / dispatches))

    def record(self, part: DispatchRange, seconds: float) -> bool:
        """Learn from a dispatch that took `seconds`; returns whether it completed the frame."""
        work = part.samples * part.tiles
        self._pace.tried = max(self._pace.tried, work)
        self._pace.cost = max(seconds, 1e-9) / work
        if part.samples == 1:
            self._pace.cost_alone = self._pace.cost
        self._done += part.tiles
        is_complete = self._done == self._tiles
        if is_complete:
            self.drop()
        return is_complete

    def _fitting(self, seconds: float, cost: float) -> float:
        """Samples x tiles that fit into `seconds`; at most GROWTH times what has been tried."""
        most = GROWTH * self._pace.tried
        return min(most, seconds / cost) if cost else most
