"""Pictures that cannot be merged are refused, with what is wrong and what to do."""

import re
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import pytest

from glrt.core.errors import UsageError
from glrt.image.image import Image
from glrt.image.merge import merge
from glrt.image.recipe import Recipe
from tests.support.raw_samples import BLOCK, Render, render_of
from tests.support.renders import same

RENDER = render_of(9 * BLOCK + 5, "normal", "depth")


def recipe_of(image: Image) -> Recipe:
    assert image.recipe
    return image.recipe


def parts(count: int, numbers: Sequence[int] = (), of: Render = RENDER) -> list[Image]:
    """Parts of a render by their numbers, or all."""
    return [of.part(number, count) for number in numbers or range(1, count + 1)]


def changed(image: Image, **changes: Any) -> Image:
    """The image with another recipe."""
    return replace(image, recipe=recipe_of(image).model_copy(update=changes))


def with_settings(image: Image, **settings: Any) -> Image:
    return changed(image, settings=recipe_of(image).settings.model_copy(update=settings))


def with_another_scene(image: Image) -> Image:
    camera = recipe_of(image).scene.camera.model_copy(update={"fov": 30.0})
    return changed(image, scene=recipe_of(image).scene.model_copy(update={"camera": camera}))


def of_settings(**settings: Any) -> Callable[[], list[Image]]:
    """Three parts: the second has other settings."""

    def made() -> list[Image]:
        first, second, third = parts(3)
        return [first, with_settings(second, **settings), third]

    return made


def edited(edit: Callable[[Image], Image]) -> Callable[[], list[Image]]:
    """Three parts: the second is edited."""
    return lambda: [image if n != 1 else edit(image) for n, image in enumerate(parts(3))]


REFUSED: dict[str, tuple[Callable[[], list[Image]], str]] = {
    "nothing": (list, "There is nothing to merge: give the parts"),
    "no recipe": (
        edited(lambda image: replace(image, recipe=None)),
        "image 2 is not a part of a render: `glrt render --part K/N` makes parts",
    ),
    "not a part": (edited(lambda image: changed(image, partition=None)), "image 2 is not a part"),
    "merged already": (
        lambda: [merge(parts(3, (1, 2)), incomplete=True), *parts(3, (3,))],
        "image 1 was merged already, of parts 1, 2 of 3",
    ),
    "interrupted": (
        edited(lambda image: changed(image, samples=17)),
        "image 2 has 17 of its 48 samples: it was interrupted",
    ),
    "not begun": (edited(lambda image: changed(image, samples=0)), "image 2 has 0 of its 48"),
    "other seed": (of_settings(seed=1), "seed is 0 in image 1 and 1 in image 2"),
    "other method": (of_settings(method="nee"), "method is mis in image 1 and nee in image 2"),
    "other roulette": (of_settings(roulette=False), "roulette is True in image 1 and False"),
    "other crop": (of_settings(crop=(0, 0, 4, 3)), "crop is not given in image 1 and"),
    "other AOVs": (of_settings(aov=("depth",)), "aov is .* in image 1 and .'depth',. in image 2"),
    "other samples": (of_settings(samples=150), "samples is 149 in image 1 and 150 in image 2"),
    "other version": (
        edited(lambda image: changed(image, version="9.9")),
        "version is 0.1.0 in image 1 and 9.9 in image 2",
    ),
    "other scene": (edited(with_another_scene), "camera.fov is .* in image 1 and 30.0 in image 2"),
    "other count": (
        lambda: [RENDER.part(1, 3), RENDER.part(2, 2)],
        "the number of parts is 3 in image 1 and 2 in image 2",
    ),
    "twice": (lambda: parts(3, (1, 2, 3, 2)), "image 2 and image 4 are both part 2 of 3"),
    "one missing": (
        lambda: parts(3, (1, 3)),
        "1 of 3 parts are missing: 2. Render what is missing, as with --part 2/3, or give",
    ),
    "many missing": (
        lambda: parts(10, (4,), render_of(10 * BLOCK)),
        "9 of 10 parts are missing: 1, 2, 3, 5, 6, 7, 8, 9, 10. ",
    ),
    "lost film": (
        edited(lambda image: replace(image, film_state=None)),
        "image 2 lacks the state of its film",
    ),
    "lost AOVs": (
        lambda: [replace(RENDER.part(1, 2), aovs={}), RENDER.part(2, 2)],
        "image 1 lacks the state of its film",
    ),
    "lost AOV": (
        edited(lambda image: replace(image, aovs={"depth": image.aovs["depth"]})),
        "image 2 lacks the state of its film",
    ),
}


def refusal(images: list[Image], incomplete: bool = False) -> str:
    """The message that refuses to merge pictures; empty if they can be merged."""
    try:
        merge(images, incomplete)
    except UsageError as error:
        return str(error)
    return ""


@pytest.mark.parametrize("name", REFUSED)
def test_what_cannot_be_merged_is_refused_by_its_reason(name: str) -> None:
    """The message names the parts that differ; only missing parts may be forgiven."""
    made, said = REFUSED[name]
    assert re.search(said, refusal(made()))
    if "missing" in name:
        assert refusal(made(), incomplete=True) == ""
    else:
        assert re.search(said, refusal(made(), incomplete=True))


def test_a_part_that_lost_its_numbers_of_objects_is_refused() -> None:
    """They belong to no film, and are not merged: the first part's numbers count."""
    render = render_of(2 * BLOCK, "object")
    given = [replace(render.part(1, 2), aovs={}), render.part(2, 2)]
    assert "image 1 lacks the state of its film" in refusal(given)


def test_of_many_missing_parts_ten_are_named() -> None:
    given = parts(40, (1,), render_of(40 * BLOCK))
    assert "39 of 40 parts are missing: 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, ...." in refusal(given)


@pytest.mark.parametrize("settings", [{"exposure": 2.0}, {"tonemap": "agx"}])
def test_what_changes_no_sample_may_differ(settings: dict[str, Any]) -> None:
    first, second, third = parts(3)
    found = merge([first, with_settings(second, **settings), third])
    assert same(found, merge([first, second, third]))
