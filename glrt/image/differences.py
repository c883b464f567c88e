"""Differences of the recipes of two pictures, in words."""

from collections.abc import Iterator
from typing import Any, NamedTuple

from glrt.image.recipe import Recipe
from glrt.scene.scenefile.toml import scene_to_dict


class Pair(NamedTuple):
    """Two recipes, and how messages name the place of their values."""

    left: Recipe
    right: Recipe
    in_left: str = "in the picture"
    in_right: str = "now"

    def report(self, name: str, before: Any, after: Any) -> Iterator[str]:
        """Yield a sentence if two values differ."""
        if before != after:
            yield f"{name} is {_shown(before)} {self.in_left} and {_shown(after)} {self.in_right}"


def differing_settings(pair: Pair, names: list[str]) -> Iterator[str]:
    """Yield a sentence for each of these settings that differs."""
    for name in names:
        yield from pair.report(
            name, getattr(pair.left.settings, name), getattr(pair.right.settings, name)
        )


def differing_scenes(pair: Pair) -> Iterator[str]:
    """Yield differences of scenes and their files, except title and samples of the scene."""
    yield from _apart(pair, "", _content(pair.left), _content(pair.right))
    before, after = pair.left.assets, pair.right.assets
    for path in before.keys() & after.keys():
        yield from pair.report(f"the SHA-256 of {path}", before[path][:12], after[path][:12])


def differing_fields(pair: Pair, names: tuple[str, ...]) -> Iterator[str]:
    """Yield a sentence for each of these recipe fields that differs."""
    for name in names:
        yield from pair.report(name, getattr(pair.left, name), getattr(pair.right, name))


def first_of(differences: list[str]) -> str:
    """The first of some differences, and the number of the others."""
    more = f" ({len(differences) - 1} more differ)" if len(differences) > 1 else ""
    return f"{differences[0]}{more}"


def _content(recipe: Recipe) -> dict[str, Any]:
    table = scene_to_dict(recipe.scene)
    table.pop("title", None)
    table.get("render", {}).pop("samples", None)
    return table


def _apart(pair: Pair, place: str, before: Any, after: Any) -> Iterator[str]:
    """Yield a sentence for each difference of two values at a place in a scene."""
    if isinstance(before, dict) and isinstance(after, dict):
        for key in dict.fromkeys([*before, *after]):
            where = f"{place}.{key}" if place else f"{key}"
            yield from _apart(pair, where, before.get(key), after.get(key))
    elif place == "objects" and len(before) == len(after):
        for number, both in enumerate(zip(before, after, strict=True)):
            yield from _apart(pair, f"objects[{number}]", *both)
    elif place == "objects":
        yield from pair.report("the number of objects", len(before), len(after))
    else:
        yield from pair.report(place, before, after)


def _shown(value: Any) -> str:
    text = "not given" if value is None else str(value)
    return text if len(text) <= 80 else f"{text[:80]}..."
