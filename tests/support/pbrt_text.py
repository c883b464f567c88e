"""A strict reader of pbrt-v4 scene files, of the directives that `glrt export` writes.

It stands in for pbrt, which no test runs: it knows the grammar of https://pbrt.org/fileformat-v4.
"""

import re
from typing import Any, NamedTuple

_TOKEN = re.compile(r'#[^\n]*|"(?:\\.|[^"\\\n])*"|[\[\]]|[^\s"\[\]#]+')
_TEXTS = {  # how many texts in quotes follow each directive that takes parameters
    **dict.fromkeys(("Camera", "Film", "PixelFilter", "Sampler", "Integrator", "Material"), 1),
    **dict.fromkeys(("LightSource", "AreaLightSource", "Shape", "MakeNamedMedium"), 1),
    "MakeNamedMaterial": 1,
    "Texture": 3,
}
_PLAIN = {  # directives without parameters: how many texts and numbers
    "AttributeBegin": (0, 0),
    "AttributeEnd": (0, 0),
    "WorldBegin": (0, 0),
    "ObjectEnd": (0, 0),
    "ObjectBegin": (1, 0),
    "ObjectInstance": (1, 0),
    "NamedMaterial": (1, 0),
    "MediumInterface": (2, 0),
    "Scale": (0, 3),
    "LookAt": (0, 9),
    "ConcatTransform": (0, 16),
}
_SIZES = {"rgb": 3, "point3": 3, "point2": 2, "float": 1, "integer": 1}  # a count is a multiple


class Line(NamedTuple):
    """A directive."""

    name: str
    texts: tuple[str, ...]
    numbers: tuple[float, ...]
    parameters: dict[str, Any]  # by type and name


def read_pbrt(text: str) -> list[Line]:
    """The directives; AssertionError where the text is not as the format wants it."""
    tokens = [it for it in _TOKEN.findall(text) if not it.startswith("#")]
    rest = _TOKEN.sub("", text).strip()
    assert not rest, f"signs that belong to no token: {rest[:40]!r}"
    found = []
    while tokens:
        name = tokens.pop(0)
        assert name in _TEXTS or name in _PLAIN, name
        count, numbers = _PLAIN.get(name, (_TEXTS.get(name), 0))
        texts = tuple(_text(tokens.pop(0)) for _ in range(count or 0))
        values = tuple(_numbers(tokens, numbers)) if numbers else ()
        parameters: dict[str, Any] = {}
        while name in _TEXTS and tokens and tokens[0].startswith('"'):
            key = _text(tokens.pop(0))
            assert key not in parameters, key
            parameters[key] = _value(key.split(" ")[0], tokens)
        found.append(Line(name, texts, values, parameters))
    _check(found)
    return found


def _text(token: str) -> str:
    assert len(token) > 1, token
    assert token[0] == token[-1] == '"', token
    return re.sub(r"\\(.)", r"\1", token[1:-1])


def _numbers(tokens: list[str], count: int) -> list[float]:
    listed = tokens[0] == "["
    if listed:
        tokens.pop(0)
    found = [float(tokens.pop(0)) for _ in range(count)]
    if listed:
        assert tokens.pop(0) == "]"
    return found


def _value(kind: str, tokens: list[str]) -> Any:
    """A value of a parameter, or the list between brackets."""
    if tokens[0] != "[":
        return _one(kind, tokens.pop(0))
    tokens.pop(0)
    found = []
    while tokens[0] != "]":
        found.append(_one(kind, tokens.pop(0)))
    tokens.pop(0)
    assert found
    assert len(found) % _SIZES.get(kind, 1) == 0
    assert kind != "rgb" or len(found) == _SIZES[kind]
    return found


def _one(kind: str, token: str) -> Any:
    if kind in ("string", "texture"):
        return _text(token)
    if kind == "bool":
        assert token in ("true", "false"), token
        return token == "true"
    assert kind in _SIZES, kind
    value = int(token) if kind == "integer" else float(token)
    assert abs(value) < float("inf"), token
    return value


def _check(lines: list[Line]) -> None:
    """Attributes and objects are closed, the world begins once, and names are defined before."""
    names: dict[str, set[str]] = {
        "material": set(),
        "medium": {""},
        "object": set(),
        "image": set(),
    }
    depth, in_object, in_world = 0, False, False
    for line in lines:
        depth += {"AttributeBegin": 1, "AttributeEnd": -1}.get(line.name, 0)
        assert depth >= 0
        if line.name == "WorldBegin":
            assert not in_world
            in_world = True
        assert in_world or line.name not in ("Shape", "LightSource", "NamedMaterial", "Texture")
        assert not in_world or line.name not in ("Camera", "Film", "Sampler", "Integrator")
        if line.name in ("ObjectBegin", "ObjectEnd"):
            in_object = not in_object
            assert in_object == (line.name == "ObjectBegin")
        kinds = {"MakeNamedMaterial": "material", "MakeNamedMedium": "medium", "Texture": "image"}
        if kind := {**kinds, "ObjectBegin": "object"}.get(line.name):
            assert line.texts[0] not in names[kind], f"{line.texts[0]} is defined twice"
            names[kind].add(line.texts[0])
        uses = {
            "NamedMaterial": "material",
            "MediumInterface": "medium",
            "ObjectInstance": "object",
        }
        if kind := uses.get(line.name):
            assert set(line.texts) <= names[kind], line
        for key, value in line.parameters.items():
            assert not key.startswith("texture ") or value in names["image"], key
    assert depth == 0
    assert not in_object
    assert in_world
