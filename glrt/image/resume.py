"""Check whether a render can continue a picture, and name what differs."""

from collections.abc import Iterator
from typing import Any

from glrt.errors import UsageError
from glrt.image.film_state import FilmState
from glrt.image.image import Image
from glrt.image.recipe import Recipe
from glrt.scene.toml import scene_to_dict
from glrt.settings import Cost, cost_of

SAME = ("version", "renderer", "tier", "pipeline")  # else no recipe would give the same bits again


def recipe_to_resume(image: Image) -> Recipe:
    """The recipe of a picture that holds all that a render needs to go on.

    Raises UsageError, with what is missing.
    """
    if image.recipe is None:
        raise UsageError("it has no recipe: glrt did not render it, or another program saved it")
    if image.recipe.traced:
        raise UsageError(
            "its light was changed in the window: it lacks the layers that it was summed from"
        )
    if image.film_state is None:
        raise UsageError(
            "it has no film state: another renderer or an older glrt wrote it, or another program "
            "saved it again"
        )
    return image.recipe


def fitting(image: Image, wanted: Recipe) -> FilmState:
    """What the film of a picture had gathered, if a render by the recipe `wanted` would gather it.

    Title and samples of the scene may differ, and settings that cost nothing. Raises UsageError
    that names what else does.
    """
    recipe = recipe_to_resume(image)
    differences = [*_differences(recipe, wanted)]
    if differences:
        more = f" ({len(differences) - 1} more differ)" if len(differences) > 1 else ""
        raise UsageError(f"{differences[0]}{more}")
    assert image.film_state is not None
    return image.film_state


def _differences(recipe: Recipe, wanted: Recipe) -> Iterator[str]:
    """What the picture has and what is wanted, one difference at a time."""
    for name in type(recipe.settings).model_fields:
        if cost_of(name) is not Cost.FREE:
            yield from _told(name, getattr(recipe.settings, name), getattr(wanted.settings, name))
    yield from _apart("", _content(recipe), _content(wanted))
    for name in SAME:
        yield from _told(name, getattr(recipe, name), getattr(wanted, name))


def _content(recipe: Recipe) -> dict[str, Any]:
    """The scene, less what changes no sample."""
    table = scene_to_dict(recipe.scene)
    table.pop("title", None)
    table.get("render", {}).pop("samples", None)
    return table


def _apart(place: str, before: Any, after: Any) -> Iterator[str]:
    """Where two values out of a scene differ."""
    if isinstance(before, dict) and isinstance(after, dict):
        for key in dict.fromkeys([*before, *after]):
            where = f"{place}.{key}" if place else f"{key}"
            yield from _apart(where, before.get(key), after.get(key))
    elif place == "objects" and len(before) == len(after):
        for number, pair in enumerate(zip(before, after, strict=True)):
            yield from _apart(f"objects[{number}]", *pair)
    elif place == "objects":
        yield from _told("the number of objects", len(before), len(after))
    else:
        yield from _told(place, before, after)


def _told(name: str, before: Any, after: Any) -> Iterator[str]:
    if before != after:
        yield f"{name} is {_shown(before)} in the picture and {_shown(after)} now"


def _shown(value: Any) -> str:
    text = "not given" if value is None else str(value)
    return text if len(text) <= 80 else f"{text[:80]}..."
