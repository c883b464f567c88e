"""Merge the parts of a render into one picture, whoever rendered them and in whatever order."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from glrt.core.errors import UsageError
from glrt.core.text import counted
from glrt.image import group_channels, shared_numbers
from glrt.image.aovs import AovImage
from glrt.image.differences import (
    Pair,
    differing_fields,
    differing_scenes,
    differing_settings,
    first_of,
)
from glrt.image.film_moments import (
    GROUPS,
    NOTHING,
    PARTICLES,
    RADIANCE,
    groups_of,
    moments_of,
)
from glrt.image.film_state import FilmState, error_of_mean
from glrt.image.image import Image
from glrt.image.moments import Moments, merged
from glrt.image.particle_film import ParticleFilm, observations_of, summed
from glrt.image.partition import Partition
from glrt.image.recipe import Recipe
from glrt.settings import Settings

Recipes = Mapping[str, Recipe]  # by the names of pictures in messages

_DRIVERS = ("renderer", "tier", "pipeline")  # the last bits of samples may depend on these


def merge(images: Sequence[Image], incomplete: bool = False) -> Image:
    """Merge all parts of a render (`glrt.render(scene, part=(k, n))`) into one picture.

    With `incomplete`, parts may be missing: the picture of the others has its own error. Otherwise
    missing parts raise UsageError. So do pictures that are no parts, or not of one render, a part
    that is given twice, and a part that was not rendered to its end.
    """
    named = {f"image {number}": image for number, image in enumerate(images, 1)}
    recipes = {name: image.recipe for name, image in named.items()}
    return merged_image(recipes, named.__getitem__, incomplete)


def merged_image(
    recipes: Mapping[str, Recipe | None], load: Callable[[str], Image], incomplete: bool = False
) -> Image:
    """Merge named pictures as `merge` does; `load` reads each when it is needed, once per film.

    So few are held at a time: about the binary logarithm of their number.
    """
    parts = checked(recipes, incomplete)
    aovs = next(iter(parts.values())).settings.kept
    order = sorted(parts, key=lambda name: _number(parts[name]))
    if len(order) == 1:
        return load(order[0])

    def film_of(film: str, name: str) -> Mapping[str, Moments]:
        found = moments_of(load(name), film)
        if found is None:
            raise _incomplete(name)
        return {film: found}

    def whole(film: str) -> Moments:
        return merged([partial(film_of, film, name) for name in order])[film]

    recipe = _recipe_of([parts[name] for name in order])
    groups = whole(GROUPS) if recipe.settings.division.is_shared else None
    image = _image(whole(RADIANCE), recipe, groups)
    objects = _objects_of(order[0], load(order[0])) if "object" in aovs else AovImage(NOTHING)
    found = {a: objects if a == "object" else _aov_image(a, whole(a)) for a in aovs}
    if groups and image.film_state:
        shown = shared_numbers.picture(image.radiance, image.film_state.groups, found)
        image = replace(image, **shown._asdict())
    if recipe.settings.caustics == "on":
        image = _with_particles(image, whole(PARTICLES), recipe)
    return replace(image, aovs=found)


def checked(recipes: Mapping[str, Recipe | None], incomplete: bool) -> Recipes:
    """The recipes of pictures that can be merged; UsageError says why they cannot."""
    parts = {name: _part_of(name, recipe) for name, recipe in recipes.items()}
    if not parts:
        raise UsageError("There is nothing to merge: give the parts of a render.")
    (first, recipe), *others = parts.items()
    for name, other in others:
        pair = Pair(recipe, other, f"in {first}", f"in {name}")
        if differences := _differences(pair):
            raise UsageError(f"Not parts of one render: {first_of(differences)}.")
    _check_numbers(parts, incomplete)
    return parts


def _part_of(name: str, recipe: Recipe | None) -> Recipe:
    """The recipe of a complete part; UsageError for any other picture."""
    if recipe is None or recipe.partition is None:
        raise UsageError(f"{name} is not a part of a render: `glrt render --part K/N` makes parts.")
    if len(recipe.partition.numbers) > 1:
        raise UsageError(
            f"{name} was merged already, of parts {recipe.partition}; give the parts themselves, "
            "so that the bits of the picture do not depend on the order of merges."
        )
    wanted = recipe.partition.samples(recipe.settings)
    if recipe.samples != wanted:
        raise UsageError(
            f"{name} has {recipe.samples} of its {counted(wanted, 'sample')}: it was interrupted; "
            f"finish it with `glrt render --resume {name} -o {name}`."
        )
    return recipe


def _differences(pair: Pair) -> list[str]:
    settings = [name for name in Settings.model_fields if name not in ("exposure", "tonemap")]
    counts = [recipe.partition.count for recipe in (pair.left, pair.right) if recipe.partition]
    return [
        *differing_fields(pair, ("version",)),
        *differing_settings(pair, settings),
        *pair.report("the number of parts", *counts),
        *differing_scenes(pair),
    ]


def _check_numbers(parts: Recipes, incomplete: bool) -> None:
    held: dict[int, str] = {}
    for name, recipe in parts.items():
        number = _number(recipe)
        if number in held:
            raise UsageError(
                f"{held[number]} and {name} are both part {recipe.partition}; leave one out."
            )
        held[number] = name
    missing = _recipe_of(list(parts.values())).partition
    if missing and not missing.is_complete and not incomplete:
        numbers, count = missing.missing, missing.count
        shown = ", ".join(map(str, numbers[:10])) + (", ..." if len(numbers) > 10 else "")
        raise UsageError(
            f"{len(numbers)} of {count} parts are missing: {shown}. Render what is missing, "
            f"as with --part {numbers[0]}/{count}, or give --incomplete for the picture of the "
            "others."
        )


def _number(recipe: Recipe) -> int:
    assert recipe.partition
    return recipe.partition.numbers[0]


def _recipe_of(parts: Sequence[Recipe]) -> Recipe:
    """The recipe of the merged picture."""
    assert parts[0].partition
    numbers = tuple(sorted(map(_number, parts)))
    partition = Partition(count=parts[0].partition.count, numbers=numbers)
    drivers = {n: " and ".join(sorted({getattr(p, n) for p in parts})) for n in _DRIVERS}
    samples = partition.samples(parts[0].settings)
    return parts[0].model_copy(update={"partition": partition, "samples": samples, **drivers})


def _objects_of(name: str, image: Image) -> AovImage:
    """The numbers of objects, which are the same in each part."""
    if "object" not in image.aovs:
        raise _incomplete(name)
    return image.aovs["object"]


def _incomplete(name: str) -> UsageError:
    return UsageError(
        f"{name} lacks the state of its film: another program saved it again; render it again."
    )


def _with_particles(image: Image, moments: Moments, recipe: Recipe) -> Image:
    """The picture of the camera's film, plus the light of particles."""
    mean, variance = moments.mean.astype(np.float32), moments.variance.astype(np.float32)
    film = ParticleFilm(image.radiance, mean, variance)
    observations = observations_of(recipe.samples, recipe.settings.division.points)
    radiance, stderr = summed(film, image.stderr, observations)
    return replace(image, radiance=radiance, stderr=stderr, particles=film)


def _image(film: Moments, recipe: Recipe, groups: Moments | None = None) -> Image:
    """The picture of a film, with groups of shared numbers if there are any."""
    means = group_channels.NO_GROUPS
    if groups:
        means = groups_of(groups, recipe.settings.division.groups)
    shape = film.mean.shape
    wide = film.mean, film.variance, np.broadcast_to(film.part, shape)
    mean, variance, part = (x.astype(np.float32) for x in wide)
    begun_counts = np.broadcast_to(film.begun, film.samples.shape)
    count, observations, begun = (
        x[..., 0].astype(np.float32) for x in (film.samples, film.observations, begun_counts)
    )
    share = np.asarray(begun / np.maximum(count, 1), np.float32)
    stderr = error_of_mean(mean, variance, observations, part, share)
    state = FilmState(variance, recipe.samples - count, observations, part, begun, means)
    return Image(mean, stderr, recipe.samples, recipe, state)


def _aov_image(name: str, film: Moments) -> AovImage:
    mean, variance = film.mean.astype(np.float32), film.variance.astype(np.float32)
    counts = [x[..., 0].astype(np.uint32) for x in (film.samples, film.observations)]
    observations = counts[1].astype(np.float32)
    no_part = np.zeros_like(mean), np.zeros_like(observations)
    stderr = error_of_mean(mean, variance, observations, *no_part)
    if name == "depth":
        value = np.where(film.samples > 0, mean, np.float32(np.inf))
        return AovImage(value[..., 0], stderr[..., 0], *counts)
    if name == "bounces":
        return AovImage(mean[..., 0], stderr[..., 0], *counts)
    return AovImage(mean, stderr, *counts)
