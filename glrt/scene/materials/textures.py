"""Images and checkerboards that stand for a color or a number of a material."""

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Annotated, Any, Literal, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import BeforeValidator, Field, WithJsonSchema, model_validator

from glrt.scene.files.named_images import ColorImage, DataImage, NamedTexture, Texels, TextureImage
from glrt.scene.values import LARGEST, Angle, Color, Coordinate, Number, Triple, Value
from glrt.settings import Editable

Channel = Literal["r", "g", "b", "a"]


def _two(value: Any) -> Any:
    return (value, value) if isinstance(value, float | int | str) else value


def _grey(value: Any) -> Any:
    """Turn numbers among two colors into greys."""
    if not isinstance(value, tuple):
        return value
    if len(value) != 2:
        raise ValueError("must be a list of two colors or two numbers")
    return tuple((each,) * 3 if isinstance(each, float | int) else each for each in value)


_NUMBER = {"type": "number", "minimum": -LARGEST, "maximum": LARGEST}
_TWO = {"anyOf": [_NUMBER, {"type": "array", "items": _NUMBER, "minItems": 2, "maxItems": 2}]}
_WRAP = {"enum": ["repeat", "mirror", "clamp"]}
_TWO_WRAPS = {"anyOf": [_WRAP, {"type": "array", "items": _WRAP, "minItems": 2, "maxItems": 2}]}
Pair = Annotated[tuple[Coordinate, Coordinate], BeforeValidator(_two), WithJsonSchema(_TWO)]
Wrap = Literal["repeat", "mirror", "clamp"]
Wraps = Annotated[tuple[Wrap, Wrap], BeforeValidator(_two), WithJsonSchema(_TWO_WRAPS)]


class Texture(Value):
    """An image or a checkerboard over the texture coordinates of a surface.

    Exactly one of `image` and `checker` is given. An image of colors is decoded from sRGB; other
    numbers are the codes of an image, from 0 to 1.
    """

    image: NamedTexture | None = Field(None, description="path of an image, or FILE.glb#NUMBER")
    checker: Annotated[tuple[Color, Color], BeforeValidator(_grey)] | None = Field(
        None, description="two colors, or numbers, of fields that alternate, two by two in a repeat"
    )
    factor: Any = Field(
        None, exclude=True, description="by which the value is multiplied; default: 1"
    )
    channel: Channel | None = Field(
        None, description="of the image, alone; default: its colors, and of a number the first"
    )
    scale: Pair = Field((1.0, 1.0), description="how often it repeats within 0 to 1, along u and v")
    offset: Pair = Field((0.0, 0.0), description="what is added to u and v, after all else")
    rotation: Annotated[Angle, Editable(unit="degrees", slider=(-180, 180))] = Field(
        0.0, description="by which the coordinates are turned, as in glTF, after scale"
    )
    wrap: Wraps = Field(
        ("repeat", "repeat"),
        description="what lies beyond the image, or along u and v: it again, mirrored, or its edge",
    )
    filter: Literal["linear", "nearest"] = Field(
        "linear", description="between the middles of pixels; a checkerboard is always sharp"
    )
    uv: Literal[0, 1] = Field(0, description="set of texture coordinates of a mesh")

    if TYPE_CHECKING:

        def __init__(
            self,
            *,
            image: str | None = None,
            checker: tuple[Triple, Triple] | tuple[Number, Number] | None = None,
            factor: Number | Triple = 1.0,
            channel: Channel | None = None,
            scale: Number | tuple[Number, Number] = 1.0,
            offset: Number | tuple[Number, Number] = 0.0,
            rotation: Number = 0.0,
            wrap: Wrap | tuple[Wrap, Wrap] = "repeat",
            filter: Literal["linear", "nearest"] = "linear",
            uv: Literal[0, 1] = 0,
        ) -> None: ...

    @model_validator(mode="after")
    def _is_one_thing(self) -> Self:
        if (self.image is None) == (self.checker is None):
            raise ValueError("must have either image or checker")
        return self

    @property
    def told(self) -> str:
        """Name of the texture in words: the path of the image, or "a checkerboard"."""
        return "a checkerboard" if self.image is None else self.image.file

    @property
    def transform(self) -> NDArray[np.float64]:
        """The matrix, (2, 3), that takes (u, v, 1) to a place in the image.

        It scales, turns, then moves, as KHR_texture_transform of glTF does.
        """
        angle = math.radians(self.rotation)
        cos, sin = math.cos(angle), math.sin(angle)
        turned = np.array([[cos, sin], [-sin, cos]]) * np.array(self.scale)
        return np.column_stack([turned, self.offset])

    @property
    def source(self) -> TextureImage | tuple[Color, Color] | None:
        """The image or the colors of a checkerboard; equal for textures that share texels."""
        return self.image if self.image is not None else self.checker

    @property
    def texels(self) -> Texels:
        """Texels, (H, W, 4), linear, row 0 on top; ValueError before the image is read."""
        if self.checker is not None:
            first, second = ((*color, 1.0) for color in self.checker)
            return np.array([[first, second], [second, first]], np.float16)
        if self.image is None or self.image.texels is None:
            raise ValueError(f"the image {self.image.file if self.image else ''} was not read")
        return self.image.texels


_REFUSED = ("factor", "checker")


def _without_refused(schema: dict[str, Any]) -> None:
    for key in _REFUSED:
        del schema["properties"][key]


class NormalTexture(Texture, json_schema_extra=_without_refused):
    """An image of normals in tangent space, x along u, y against v, z outwards."""

    strength: Annotated[float, Field(ge=0, le=100), Editable(slider=(0, 3))] = Field(
        1.0, description="factor of the inclination"
    )

    @model_validator(mode="after")
    def _has_no_factor(self) -> Self:
        if self.factor is not None or self.checker is not None:
            raise ValueError("must be an image with strength, without factor and checker")
        return self


def separated(data: Any, kinds: Mapping[str, bool]) -> Any:
    """Return the keys of a material, with keys for textures separate from keys for their factors.

    `kinds` maps the keys that may be textures to whether they are colors. A texture `x` becomes
    `x_map`, and `x` its factor, 1 by default; in a scene file `x_map` is no key.
    """
    if not isinstance(data, Mapping):
        return data
    found = dict(data)
    for name, is_color in kinds.items():
        value = found.get(name)
        if isinstance(value, Texture):
            value = {key: item for key, item in value if item is not None}
        if not isinstance(value, Mapping):
            continue
        table = dict(value)
        factor = table.pop("factor", 1.0)
        found[name] = (factor,) * 3 if is_color and isinstance(factor, float | int) else factor
        found[f"{name}_map"] = _with_kind(table, is_color)
    return found


def data_texture(value: Any) -> Any:
    """Return the table of a texture whose pixels are data, not colors; other values stay."""
    if isinstance(value, Texture):
        value = {key: item for key, item in value if item is not None}
    return _with_kind(dict(value), False) if isinstance(value, Mapping) else value


def _with_kind(table: dict[str, Any], is_color: bool) -> dict[str, Any]:
    """Return the table with an image of colors or of data; a wrong path is reported later."""
    kind, image = ColorImage if is_color else DataImage, table.get("image")
    if isinstance(image, ColorImage | DataImage) and type(image) is not kind:
        image = image.file
    if isinstance(image, str):
        table["image"] = kind.named(image)
    return table


def together(told: dict[str, Any], factors: Mapping[str, Any]) -> dict[str, Any]:
    """Return the keys of a material as `separated` takes them; `factors` are those other than 1."""
    for key in [key for key in told if key.endswith("_map")]:
        name, table = key.removesuffix("_map"), told.pop(key)
        if table is not None:
            factor = factors.get(name, 1.0)
            plain = list(factor) if isinstance(factor, tuple) else factor
            told[name] = {**table, **({"factor": plain} if name in factors else {})}
    return told


def in_one_key(schema: dict[str, Any]) -> None:
    """Change the JSON schema of a material: `x` may be a texture, in place of a key `x_map`."""
    properties = schema["properties"]
    for key in [key for key in properties if key.endswith("_map")]:
        name, texture = key.removesuffix("_map"), properties.pop(key)
        (table,) = [kind for kind in texture["anyOf"] if kind.get("type") != "null"]
        told = ("title", "description", "default")
        plain = {word: value for word, value in properties[name].items() if word not in told}
        words = {word: value for word, value in properties[name].items() if word in told}
        properties[name] = {**words, "anyOf": [plain, table]}
