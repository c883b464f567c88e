"""Validate plain tables as models, and report mistakes in the terms of a scene file.

pydantic reports what does not validate in its own terms; here its reports become sentences.
"""

import re
from collections.abc import Callable, Iterator, Mapping
from typing import Any, TypeGuard, TypeVar

from pydantic import BaseModel, ValidationError
from pydantic_core import ErrorDetails

from glrt.core.errors import SceneError
from glrt.core.text import nearest, number, shortened, unknown
from glrt.scene.schema.fields import SceneFields
from glrt.scene.schema.models import KINDS_OF, TABLES, is_of_any_length, model_of
from glrt.scene.schema.phrases import COUNTED, HEADINGS, PLAIN
from glrt.scene.values import SMALLEST, plain

MOST_PROBLEMS_NAMED = 3
_SPELT_OUT = 1e6  # whole values below it are shown with their decimal point
MOST_MISTAKES = 1 << 17  # that are listed: each takes a kilobyte

Model = TypeVar("Model", bound=BaseModel)
Place = tuple[int | str, ...]


class MisfitError(ValueError):
    """Valid parts of a scene that do not fit together: pairs of place and advice."""

    def __init__(self, problems: list[tuple[Place, str]]) -> None:
        self.problems = problems
        super().__init__(" ".join(f"{'.'.join(map(str, at))}: {text}" for at, text in problems))


def validated(model: type[Model], data: Mapping[str, Any], source: str) -> Model:
    """Return a scene or a part of one from plain tables; messages call it `source`.

    Raises `SceneError` with one paragraph that begins with `source`.
    """
    tables = plain(data)
    try:
        return model.model_validate(tables, strict=True)
    except ValidationError as error:
        if (count := error.error_count()) > MOST_MISTAKES:
            raise scene_error(source, f"not a scene: it has {count:,} mistakes") from None
        raise scene_error(source, " ".join(advice(error, tables))) from None


def scene_error(source: str, text: str) -> SceneError:
    """Return an error about a scene that messages call `source`."""
    return SceneError(sentence(f"{source}: {text}"))


def advice(error: ValidationError, data: Mapping[str, Any]) -> Iterator[str]:
    """Yield a sentence for each of the first problems, and one with the number of the others."""
    problems = _problems(error)
    for place, detail in problems[:MOST_PROBLEMS_NAMED]:
        path = _path(place[:-1] if _is_extra(detail) else place, data)
        text = detail if isinstance(detail, str) else _wording(place, detail)
        separator = " " if text.startswith(("must ", "is ")) else ": "
        yield sentence(path + separator + text if path else text)
    others = len(problems) - MOST_PROBLEMS_NAMED
    if others > 0:
        yield f"There {'is 1 other problem' if others == 1 else f'are {others} other problems'}."


def sentence(text: str) -> str:
    """Return the text with a full stop, unless it has a mark of its own."""
    return text if text.endswith((".", "?")) else text + "."


def _problems(error: ValidationError) -> list[tuple[Place, ErrorDetails | str]]:
    """Return the problems, each place once: ready advice, or details still to be worded."""
    found: dict[Place, ErrorDetails | str] = {}
    for detail in error.errors(include_url=False):
        cause = detail.get("ctx", {}).get("error")
        if isinstance(cause, MisfitError):
            found.update(cause.problems)
        else:
            found.setdefault(_place(detail), detail)
    return _without_consequences(found)


def _without_consequences(
    found: dict[Place, ErrorDetails | str],
) -> list[tuple[Place, ErrorDetails | str]]:
    """Drop keys that are missing only since they are misspelt: a misspelt key is one problem.

    A list without a valid item is too short, and its items are the problem.
    """
    meant = {
        (*place[:-1], nearest(str(place[-1]), _keys(detail)))
        for place, detail in found.items()
        if _is_extra(detail)
    }
    lists = {place[:depth] for place in found for depth in range(len(place))}
    return [
        (place, detail)
        for place, detail in found.items()
        if place not in meant and not (place in lists and _is_short(detail))
    ]


def _place(detail: ErrorDetails) -> Place:
    """Return keys and indices from the top of the file, without the tags that pydantic mixes in."""
    place: Place = detail["loc"]
    is_key = place[-1:] == ("[key]",) and not _is_extra(detail)  # an unknown key may have this name
    if is_key or detail["type"] == "invalid_key" or _is_short_vector(detail):
        place = place[:-1]
    if place[:1] in (("objects",), ("materials",)):
        place = place[:2] + place[3:]
        place = (*place[:2], *(_without_map(step) for step in place[2:]))
    if detail["type"].startswith("union_tag"):
        place = (*place, detail["ctx"]["discriminator"].strip("'"))
    return place


def _without_map(step: int | str) -> int | str:
    """Return the key of a scene file: `x` for a texture `x_map`."""
    return step.removesuffix("_map") if isinstance(step, str) else step


def _is_short_vector(detail: ErrorDetails) -> bool:
    return detail["type"] == "missing" and isinstance(detail["loc"][-1], int)


def _is_short(detail: ErrorDetails | str) -> bool:
    return not isinstance(detail, str) and detail["type"] == "too_short"


def _is_extra(detail: ErrorDetails | str) -> TypeGuard[ErrorDetails]:
    return not isinstance(detail, str) and detail["type"] == "extra_forbidden"


def _keys(detail: ErrorDetails) -> tuple[str, ...]:
    return tuple(key for key in model_of(detail["loc"]).model_fields if not key.endswith("_map"))


def _path(place: Place, data: Mapping[str, Any]) -> str:
    """Return a place as users write it: objects[2] ("left ball").radius."""
    path = ""
    for depth, step in enumerate(place):
        if isinstance(step, int) and (depth > 1 or place[0] == "objects"):
            path += f"[{step}]" + (_object_name(data["objects"][step]) if depth == 1 else "")
        else:
            name = str(step)  # Python code may have numbers as names
            key = name if re.fullmatch(r"[\w-]{1,60}", name) else f'"{shortened(name)}"'
            path += f".{key}" if path else key
    return path


def _object_name(item: Any) -> str:
    name = item.get("name") if isinstance(item, Mapping) else None
    return f' ("{shortened(name)}")' if isinstance(name, str) else ""


def _plain(place: Place, detail: ErrorDetails) -> str:
    shown = f", got {_shown(detail['input'])}"
    if detail["type"] not in PLAIN or place in HEADINGS:
        return HEADINGS.get(place, "must be a table") + shown
    limits = {key: _limit(limit) for key, limit in detail.get("ctx", {}).items()}
    subject = "its name " if detail["loc"][-1] == "[key]" else ""
    return subject + PLAIN[detail["type"]].format(**limits) + shown


def _own_words(_place: Place, detail: ErrorDetails) -> str:
    return str(detail["ctx"]["error"])


def _missing(place: Place, detail: ErrorDetails) -> str:
    if _is_short_vector(detail):
        return f"{PLAIN['tuple_type']}, got {_shown(detail['input'])}"
    description = model_of(detail["loc"]).model_fields[str(place[-1])].description
    return f"is missing; add it: {description}"


def _missing_kind(place: Place, _detail: ErrorDetails) -> str:
    return f"is missing; it must be one of: {', '.join(KINDS_OF[str(place[0])])}"


def _no_list(place: Place, detail: ErrorDetails) -> str:
    if place in HEADINGS or not is_of_any_length(detail["loc"]):
        return _plain(place, detail)
    return f"must be a list, got {_shown(detail['input'])}"


def _too_short(place: Place, detail: ErrorDetails) -> str:
    if not is_of_any_length(detail["loc"]):
        return _plain(place, detail)
    return f"must be a list of at least {detail['ctx']['min_length']}, got an empty one"


def _too_long(place: Place, detail: ErrorDetails) -> str:
    if is_of_any_length(detail["loc"]) and place not in COUNTED:
        most, count = detail["ctx"]["max_length"], len(detail["input"])
        return f"must be a list of at most {most}, got one of {count}"
    if place not in COUNTED:
        return f"{PLAIN['tuple_type']}, got {_shown(detail['input'])}"
    most = f"{detail['ctx']['max_length']:,} {COUNTED[place]}"
    return f"must be at most {most}, got {len(detail['input']):,}"


def _too_small(place: Place, detail: ErrorDetails) -> str:
    if detail["ctx"]["ge"] == SMALLEST and detail["input"] <= 0:
        return f"must be greater than 0, got {_shown(detail['input'])}"
    return _plain(place, detail)


def _unknown_key(_place: Place, detail: ErrorDetails) -> str:
    model, key = model_of(detail["loc"]), str(detail["loc"][-1])
    kind = "scene" if model is SceneFields else model.__name__.lower()
    owner = next((f"[{name}]" for name, it in TABLES.items() if it is model), f"a {kind}")
    text = unknown("key", key, _keys(detail), f"Keys of {owner}")
    if model is not SceneFields and key in SceneFields.model_fields:
        text += f" The {key} of the scene itself must stand above the first [table]."
    return text


def _unknown_choice(place: Place, detail: ErrorDetails) -> str:
    key, context, value = str(place[-1]), detail["ctx"], detail["input"]
    expected = context.get("expected_tags") or context["expected"]
    choices = [a or b.lower() for a, b in re.findall(r"'([^']*)'|\b(True|False)\b", expected)]
    word = value[key] if detail["type"] == "union_tag_invalid" else value
    if not isinstance(word, str):
        return f"must be one of: {', '.join(choices)}, got {_shown(word)}"
    return unknown(key, word, choices, "It must be one of")


_WORDINGS: dict[str, Callable[[Place, ErrorDetails], str]] = {
    "value_error": _own_words,
    "missing": _missing,
    "union_tag_not_found": _missing_kind,
    "tuple_type": _no_list,
    "too_short": _too_short,
    "too_long": _too_long,
    "greater_than_equal": _too_small,
    "extra_forbidden": _unknown_key,
    "union_tag_invalid": _unknown_choice,
    "literal_error": _unknown_choice,
}


def _wording(place: Place, detail: ErrorDetails) -> str:
    return _WORDINGS.get(detail["type"], _plain)(place, detail)


def _limit(value: Any) -> str:
    return number(value) if isinstance(value, float) else _shown(value)


def _shown(value: Any) -> str:
    """Return a value of a scene file, short enough for a message."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, int):
        return str(value) if abs(value) < 10**20 else "a number of more than 20 digits"
    if isinstance(value, float):
        return repr(value) if value.is_integer() and abs(value) < _SPELT_OUT else number(value)
    if isinstance(value, str):
        return f'"{shortened(value)}"'
    if isinstance(value, list | tuple):
        return f"a list of {len(value)}"
    return "a table" if isinstance(value, Mapping) else f"a {type(value).__name__}"
