"""The page of scene files, from the models that read them."""

import inspect
from collections.abc import Iterator
from typing import Any

from pydantic import BaseModel
from reference_markdown import GENERATED, table

from glrt.phong import Phong
from glrt.scene.animation.tracks import Animation, Track
from glrt.scene.camera import Camera
from glrt.scene.density import Density
from glrt.scene.lights.background import Background
from glrt.scene.lights.clear_sky import ClearSky
from glrt.scene.lights.cone import Cone
from glrt.scene.lights.sun import Sun
from glrt.scene.materials.kinds import TYPES
from glrt.scene.materials.textures import NormalTexture, Texture
from glrt.scene.medium import Medium
from glrt.scene.probes import Probes
from glrt.scene.scene import Scene
from glrt.scene.shapes.kinds import KINDS
from glrt.scene.transfer import Transfer
from glrt.settings import RenderSettings, editable_of

NOTES = {  # on a type of material or a kind of shape
    "principled": "[Principled surfaces](../explanation/principled.md).",
    "mesh": "[Put a 3D model into a scene](../how-to/models.md).",
}
SCENE_TABLES: list[tuple[str, str, type[BaseModel]]] = [
    ("[camera]", "Required.", Camera),
    ("[render]", "Optional. Options of the command line override it.", RenderSettings),
    (
        "[render.phong]",
        "Optional. [Constants for all surfaces]"
        "(../explanation/methods.md#phongs-constants-for-all-surfaces).",
        Phong,
    ),
    ("[background]", "Optional; black by default.", Background),
    (
        "sky of [background]",
        "In TOML: `sky = { turbidity = 3.0 }`. [A clear sky](../how-to/lights.md#a-clear-sky).",
        ClearSky,
    ),
    ("[sun]", "Optional; there is none by default.", Sun),
    ("[animation]", "Optional. [Make films](../how-to/films.md).", Animation),
    ("[[animation.tracks]]", "", Track),
    ("[probes]", "Optional. [Probes](../explanation/probes.md).", Probes),
    *((f"[materials.NAME] of type {name}", NOTES.get(name, ""), TYPES[name]) for name in TYPES),
    (
        "texture",
        'In place of a color or a number: `color = { image = "wood.jpg" }`. '
        "[Textures](../how-to/textures.md).",
        Texture,
    ),
    (
        "normal of a material of type principled",
        'A texture with `strength`: `normal = { image = "bumps.png" }`.',
        NormalTexture,
    ),
    ("[media.NAME]", "Optional. [Media](../how-to/media.md).", Medium),
    (
        "density of a medium",
        'In TOML: `density = { file = "smoke.npy" }`. '
        "[Smoke](../how-to/media.md#smoke-from-a-grid).",
        Density,
    ),
    (
        "transfer of a medium",
        "In TOML: a table `[media.NAME.transfer]`. "
        "[Scientific volumes](../how-to/media.md#scientific-volumes).",
        Transfer,
    ),
    ("cone of a material", "In TOML: `cone = { axis = [0, -1, 0], outer = 30 }`.", Cone),
    *((f"[[objects]] of shape {name}", NOTES.get(name, ""), KINDS[name]) for name in KINDS),
]


WORDS = {
    "integer": "whole number",
    "number": "number",
    "string": "text",
    "boolean": "true or false",
}


def scene_file() -> Iterator[str]:
    """Keys of a scene file, from the models that read it."""
    yield "# Scene files"
    yield GENERATED
    yield (
        "A scene is a TOML file. Lengths are in scene units, angles in degrees, colours in linear "
        "sRGB; coordinates are right-handed with y up. Unknown keys, infinities and NaN are "
        "refused. [Write a scene](../how-to/write-a-scene.md) has a complete example; "
        "`glrt schema` prints the same format as JSON Schema for editors."
    )
    yield "## Top level"
    yield keys(Scene)
    for title, note, model in SCENE_TABLES:
        yield f"## `{title}`"
        yield f"{inspect.getdoc(model)} {note}".strip()
        yield keys(model)
    yield "## `[lights]`"
    yield (
        "Optional. One key a light group, with its intensity: a factor from 0, 1 by default. A "
        "lamp's group is the `group` of its object, or else that of its material, or else the "
        "material's name; the background is the group `background`."
    )


def keys(model: type[BaseModel]) -> str:
    """A table of the fields of a model."""
    schema = model.model_json_schema()
    rows = []
    for name, field in model.model_fields.items():
        if name not in schema["properties"]:
            continue  # a part of another key, or one that another model has
        part = schema["properties"][name]
        start = default(name, schema, field.default)
        cells = (f"`{name}`", kind(part), start, limits(part), editable_of(field).unit)
        rows.append((*cells, field.description or ""))
    return table(("key", "type", "default", "range", "unit", "meaning"), rows)


def kind(part: dict[str, Any]) -> str:
    """The type of a value in words."""
    if any("Texture" in option.get("$ref", "") for option in part.get("anyOf", ())):
        plain = [p for p in part["anyOf"] if "$ref" not in p and p.get("type") != "null"]
        nested = [p for option in plain for p in option.get("anyOf", [option])]
        shown = [kind(option) for option in nested if option.get("type") != "null"]
        return " or ".join([*shown, "[texture](scene-file.md#texture)"])
    if part.get("anyOf", [{}])[-1].get("type") == "array":
        return " or ".join(kind(option) for option in part["anyOf"])
    if "anyOf" in part:
        return kind(next(p for p in part["anyOf"] if p.get("type") != "null"))
    if "const" in part:
        return f"`{toml(part['const'])}`"
    if "enum" in part:
        shown = [toml(value) if isinstance(value, bool) else value for value in part["enum"]]
        return ", ".join(f"`{value}`" for value in shown)
    if "prefixItems" in part:
        first = part["prefixItems"][0]
        words = {"integer": "whole numbers", "number": "numbers"}
        what = f"rows of {kind(first)}" if "prefixItems" in first else words[first["type"]]
        return f"{len(part['prefixItems'])} {what}"
    if part.get("type") == "array":
        of = "" if "enum" in part.get("items", {}) else " numbers"
        items = part.get("items", {})
        if not {"type", "anyOf", "enum"} & items.keys():
            return "list of tables"
        if "maxItems" in part:
            least, most = part.get("minItems"), part["maxItems"]
            of = " vectors" if "prefixItems" in items else of
            return f"{most}{of}" if least in (most, None) else f"{least} to {most}{of}"
        return "list of numbers" if "type" in items else "list of numbers or vectors"
    if part.get("type") == "object" or "$ref" in part or "allOf" in part:
        return "table"
    return WORDS[str(part["type"])] if "type" in part else "number or 3 numbers"


def limits(part: dict[str, Any]) -> str:
    """The range of a number, or of each number of a list."""
    part = next((p for p in part.get("anyOf", ()) if p.get("type") != "null"), part)
    each = " each" if "prefixItems" in part else ""
    part = part["prefixItems"][0] if each else part
    above, below = part.get("exclusiveMinimum"), part.get("exclusiveMaximum")
    low, high = part.get("minimum", above), part.get("maximum", below)
    if low is None or high is None:
        return ""
    start = f"{whole(low)}" if above is None else f"above {whole(low)}"
    return f"{start} to {whole(high)}{each}" if below is None else f"{start}, below {whole(high)}"


def whole(value: float) -> str:
    """A limit without an exponent where it is a whole number of up to ten digits."""
    return str(int(value)) if value == int(value) and abs(value) < 1e10 else f"{value:g}"


def default(name: str, schema: dict[str, Any], value: Any) -> str:
    """The default of a key in TOML; bold `required` where there is none."""
    if name in schema.get("required", ()):
        return "**required**"
    if value is None or (isinstance(value, (BaseModel, dict, tuple)) and not value):
        return ""
    return "" if isinstance(value, BaseModel) else f"`{toml(value)}`"


def toml(value: Any) -> str:
    """A value as a scene file writes it."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        return f'"{value}"'
    if isinstance(value, (tuple, list)):
        return f"[{', '.join(map(toml, value))}]"
    return str(value)
