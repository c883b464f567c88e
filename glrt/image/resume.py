"""Check whether a render can continue a picture, and name what differs."""

from collections.abc import Iterator

from glrt.core.errors import UsageError
from glrt.image.differences import (
    Pair,
    differing_fields,
    differing_scenes,
    differing_settings,
    first_of,
)
from glrt.image.film_state import FilmState
from glrt.image.image import Image
from glrt.image.recipe import Recipe
from glrt.plan.methods import reuses_points
from glrt.settings import Cost, Settings, cost_of

# They must be equal: else no recipe would give the same bits again.
SAME = ("version", "renderer", "tier", "pipeline", "partition", "apart")


def recipe_to_resume(image: Image) -> Recipe:
    """The recipe of a picture that holds all that a render needs to continue.

    Raises UsageError that names what is missing.
    """
    if image.recipe is None:
        raise UsageError("it has no recipe: glrt did not render it, or another program saved it")
    if image.recipe.traced:
        raise UsageError(
            "its light was changed in the window: it lacks the layers that it was summed from"
        )
    if image.recipe.partition and len(image.recipe.partition.numbers) > 1:
        raise UsageError("it was merged: a plain render adds its samples in another order")
    settings = image.recipe.settings
    if reuses_points(settings) and image.samples % settings.block:
        raise UsageError(
            f"it ends within a block of {settings.block} samples, which share points that it does "
            f"not hold: with --reuse, only pictures of whole blocks can go on"
        )
    lacks_particles = settings.caustics == "on" and image.particles is None
    if image.film_state is None or lacks_particles:
        raise UsageError(
            "it has no film state: another renderer or an older glrt wrote it, or another program "
            "saved it again"
        )
    return image.recipe


def fitting(image: Image, wanted: Recipe) -> FilmState:
    """The film state of a picture, if a render by the recipe `wanted` can continue it.

    Title and samples of the scene may differ, and settings that cost nothing. Raises UsageError
    that names any other difference.
    """
    recipe = recipe_to_resume(image)
    if differences := [*_differences(Pair(recipe, wanted))]:
        raise UsageError(first_of(differences))
    assert image.film_state is not None
    return image.film_state


def _differences(pair: Pair) -> Iterator[str]:
    """Yield each difference that keeps a render from continuing the picture."""
    settings = [name for name in Settings.model_fields if cost_of(name) is not Cost.FREE]
    parts = ["samples"] if pair.left.partition else []  # the samples of a part depend on it
    yield from differing_settings(pair, settings + parts)
    yield from differing_scenes(pair)
    yield from differing_fields(pair, SAME)
