"""Turn a command line into a scene, settings and limits, or a picture to continue."""

import argparse
import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TypedDict, Unpack

from glrt.cli.options import file_rules, is_automatic, settings_given
from glrt.cli.sampler import by_length, with_sampler
from glrt.core.errors import UsageError
from glrt.denoise.filters import with_filter
from glrt.gpu.context import Choice, Context, Pipeline
from glrt.image.image import Image
from glrt.image.partition import Partition, one_part
from glrt.image.recipe import Recipe
from glrt.image.resume import fitting, recipe_to_resume
from glrt.image.sources import files_read, load_recipe, recipe_of
from glrt.plan.combinations import Way, check, ways_of
from glrt.process.command import since_start
from glrt.rendering.pipelines import TIERS, Tier
from glrt.rendering.renderer import Renderer
from glrt.rendering.stopping import Limits, samples_limit
from glrt.scene.frames import with_phong_of
from glrt.scene.instancing import Apart
from glrt.scene.loading.scene_files import with_files_of
from glrt.scene.scene import Scene, with_lights
from glrt.settings import MAX_SAMPLES, Cost, Settings, settings_for


@dataclass(frozen=True)
class Order:
    """A requested render."""

    scene: Scene  # with its animation
    settings: Settings
    limits: Limits
    begun: Image | None = None  # the picture to continue from
    part: tuple[int, int] | None = None  # number and count of the requested part
    merged: Partition | None = None  # the parts that the picture was merged from
    decisions: Mapping[str, str] = field(default_factory=dict)  # as in recipes


def order(arguments: argparse.Namespace) -> Order:
    """Return the render that the command line requests; raises UsageError and SceneError."""
    for name in ("time", "error"):
        check_limit(name, getattr(arguments, name))
    if arguments.resume is not None:
        return _order_to_go_on(arguments)
    if arguments.scene is None:
        raise UsageError("SCENE is missing. See `glrt render --help`.")
    scene, settings = scene_and_settings(arguments)
    recipe = recipe_of(arguments.scene)
    ways = ways_wanted(arguments, settings, recipe)
    check(ways - {Way.CLASSIC, Way.PROBES} if Way.AUTO in ways else ways)
    found = Order(scene, settings, Limits(0), decisions=_decisions_kept(arguments, recipe))
    found = _limited(arguments, found)
    return _in_parts(arguments, found if recipe else _with_sampler(arguments, found))


def frame_of(scene: Scene, settings: Settings, number: int | None) -> tuple[Scene, Settings]:
    """Return a frame of a scene, as `Scene.at_frame` does, with its settings.

    None: with the values that it was loaded with.
    """
    if number is None:
        return scene.exposed, settings
    still = scene.at_frame(number)
    return still, with_phong_of(still, scene.moved, settings)


def _decisions_kept(arguments: argparse.Namespace, recipe: Recipe | None) -> dict[str, str]:
    """Return the decisions in a picture's recipe, except for settings on the command line."""
    told, given = recipe.decisions if recipe else {}, settings_given(arguments)
    return {name: by for name, by in told.items() if name not in given}


def scene_and_settings(arguments: argparse.Namespace) -> tuple[Scene, Settings]:
    """Return the scene with its lights, and the settings: as given, else of the file or recipe."""
    scene, recipe = load_recipe(arguments.scene, file_rules(arguments))
    settings = settings_for(recipe or scene.render, **settings_given(arguments))
    return with_lights(scene, dict(arguments.lights)), settings


def _with_sampler(arguments: argparse.Namespace, order: Order) -> Order:
    """Return the order of a new render with the sampler that its length takes."""
    settings = with_sampler(arguments, order.settings)
    if settings == order.settings:
        return order
    decisions = {**order.decisions, "sampler": by_length(settings.sampler)}
    return replace(order, settings=settings, decisions=decisions)


def _in_parts(arguments: argparse.Namespace, order: Order) -> Order:
    """Return the order with the part of `--part`, or with the parts of a picture as SCENE."""
    recipe, settings = recipe_of(arguments.scene), order.settings
    if arguments.part:
        number, count = arguments.part
        length = one_part(number, count, settings).samples(settings)
        return replace(order, part=arguments.part, limits=Limits(length))
    partition = recipe.partition if recipe else None
    if not recipe or not partition:
        return order
    first = (partition.numbers[0], partition.count)
    if len(partition.numbers) > 1:
        return replace(order, part=first, merged=partition)
    length = one_part(*first, settings).samples(settings)
    is_same = settings.samples == recipe.settings.samples
    return replace(order, part=first, limits=Limits(recipe.samples if is_same else length))


def ways_wanted(
    arguments: argparse.Namespace, settings: Settings, recipe: Recipe | None
) -> set[Way]:
    """Return the ways to render that a command line requests; `recipe`: of the picture it names."""
    partition = recipe.partition if recipe and not arguments.part else None
    found = {
        Way.RESUME: arguments.resume is not None,
        Way.PART: arguments.part is not None or bool(partition and len(partition.numbers) == 1),
        Way.MERGED: bool(partition and len(partition.numbers) > 1),
        Way.LAYERS: bool(recipe and recipe.traced),
        Way.FRAGMENT: arguments.pipeline == "fragment",
        Way.AUTO: is_automatic(arguments),
        Way.TIME: arguments.time is not None,
        Way.ERROR: arguments.error is not None,
        Way.CLUSTER: is_in_bands(arguments),
    }
    return {way for way, is_asked in found.items() if is_asked} | ways_of(settings)


def is_in_bands(arguments: argparse.Namespace) -> bool:
    """Whether workers of a cluster render bands of a picture: frames of a film stay whole."""
    return getattr(arguments, "cluster", None) is not None and "outputs" in arguments


def check_limit(name: str, value: float | None) -> None:
    """Raise UsageError for a limit that is not a finite number above 0."""
    if value is not None and not 0 < value < float("inf"):
        raise UsageError(f"--{name} must be a number above 0, got {value:g}.")


def opened(order: Order, arguments: argparse.Namespace) -> Renderer:
    """Return the renderer of an order, with the samples that it continues from."""
    route, pipeline = arguments.context, arguments.pipeline
    if order.begun is None:
        recipe = recipe_of(arguments.scene)
        own: Opening = {"tier": "complete", "pipeline": pipeline, "opens_shutter": True}
        own |= {"part": order.part, "decisions": order.decisions}
        return open_renderer(order.scene, order.settings, recipe, route, **own)
    recipe = recipe_to_resume(order.begun)
    if pipeline == "auto" and recipe.pipeline == "fragment":
        pipeline = "fragment"
    tier: Tier = next((tier for tier in TIERS if tier == recipe.tier), "complete")
    with _going_on(arguments.resume):
        renderer = Renderer(
            *(order.scene, order.settings, route, tier, pipeline),
            part=order.part,
            decisions=order.decisions,
            apart=recipe.apart,
            opens_shutter=True,
        )
        return renderer.resume(order.begun)


class Opening(TypedDict, total=False):
    """Options of a renderer, as in `Renderer`."""

    tier: Tier
    pipeline: Pipeline
    part: tuple[int, int] | None
    decisions: Mapping[str, str]
    opens_shutter: bool


def open_renderer(
    scene: Scene,
    settings: Settings,
    recipe: Recipe | None,
    context: Context | Choice = "auto",
    **options: Unpack[Opening],
) -> Renderer:
    """Return a renderer of a scene; `recipe`: of the picture that the scene came from.

    A relit picture is a weighted sum of traced layers. The same layers are traced again, so that
    the same bits come out, unless light or bounces have been changed since.
    """
    light = recipe.traced if recipe else None
    apart: Apart = recipe.apart if recipe else "repeated"
    if not (recipe and light and _is_shown(recipe, scene, settings)):
        return Renderer(scene, settings, context, apart=apart, **options)
    before = settings_for(settings, bounces=light.bounces)
    traced = with_files_of(light.scene, scene)
    renderer = Renderer(traced, before, context, layering=light.layering, apart=apart, **options)
    cost = renderer.update(scene, **dict(settings))
    if cost in (None, Cost.FREE, Cost.RELIGHT):
        renderer.plan = replace(renderer.plan, weights=light.weights)
    return renderer


def _is_shown(recipe: Recipe, scene: Scene, settings: Settings) -> bool:
    return (scene, settings.bounces) == (recipe.scene, recipe.settings.bounces)


def _limited(arguments: argparse.Namespace, order: Order) -> Order:
    """Return the order with the limits of samples, time and error; the first reached ends it."""
    is_open = arguments.time is not None or arguments.error is not None
    given = getattr(arguments, "samples", None)
    samples = samples_limit(given, order.settings.samples, is_open)
    seconds = arguments.time
    deadline = None if seconds is None else time.perf_counter() - since_start() + seconds
    limits = Limits(samples, deadline, arguments.error)
    settings = with_filter(settings_for(order.settings, samples=samples))
    return replace(order, settings=settings, limits=limits)


def _order_to_go_on(arguments: argparse.Namespace) -> Order:
    """Return the order to continue a picture; UsageError for settings that change its samples."""
    image = Image.load(arguments.resume)
    found = image.recipe
    asked = settings_for(found.settings if found else Settings(), **settings_given(arguments))
    check(ways_wanted(arguments, asked, found))
    with _going_on(arguments.resume):
        recipe = recipe_to_resume(image)
        source = arguments.scene
        rules = file_rules(arguments)
        if source is None:
            scene, wished = files_read(recipe, Path(arguments.resume), rules).scene, None
        else:
            scene, wished = load_recipe(source, rules)
        scene = with_lights(scene, dict(arguments.lights))
        base = settings_for(wished or recipe.settings, samples=recipe.settings.samples)
        settings = settings_for(base, **settings_given(arguments))
        kept = _decisions_kept(arguments, recipe)
        order = _limited(arguments, Order(scene, settings, Limits(0), image, decisions=kept))
        still, of_frame = frame_of(scene, order.settings, arguments.frame)
        fitting(image, recipe.model_copy(update={"scene": still, "settings": of_frame}))
        if recipe.partition:
            return _part_to_go_on(order, recipe.partition)
        _check_samples(arguments, image.samples, order.limits)
    return order


def _part_to_go_on(order: Order, partition: Partition) -> Order:
    length = partition.samples(order.settings)
    return replace(order, part=(partition.numbers[0], partition.count), limits=Limits(length))


def _check_samples(arguments: argparse.Namespace, taken: int, limits: Limits) -> None:
    if limits.samples < taken:
        raise UsageError(
            f"it has {taken} samples already; --samples {limits.samples} is the number in all"
        )
    is_given = any(getattr(arguments, name, None) for name in ("samples", "time", "error"))
    if limits.samples == MAX_SAMPLES > taken and not is_given:
        raise UsageError(
            "it was rendered without a limit of samples; give --samples, --time or --error"
        )


@contextmanager
def _going_on(path: str) -> Iterator[None]:
    """Name the picture in the UsageError for a render that cannot be continued."""
    try:
        yield
    except UsageError as error:
        text = str(error).rstrip(".")
        raise UsageError(f"Cannot continue {path}: {text}. Render the scene again.") from None
