"""Base classes of materials, and the alpha of GGX."""

from collections.abc import Callable, Mapping
from typing import Annotated, Any, ClassVar, Self

from pydantic import ConfigDict, Field, model_serializer, model_validator

from glrt.scene.files.named_images import TextureImage
from glrt.scene.lights.cone import Cone
from glrt.scene.materials.textures import Texture, in_one_key, separated, together
from glrt.scene.values import (
    BLACK,
    WHITE,
    Angle,
    Color,
    Fraction,
    Name,
    Radiance,
    Tagged,
    require_tag,
)
from glrt.settings import Cost, Editable

# Facets that are rougher in one direction: docs/explanation/principled.md says where u grows.
Anisotropy = Annotated[Fraction, Editable(Cost.RECOMPILE)]
Rotation = Annotated[Angle, Editable(unit="degrees", slider=(-180, 180))]

ANISOTROPY = "how much rougher facets are in one direction: alpha there is alpha + (1 - alpha) x^2"
ROTATION = "of that direction, in degrees from where u grows, towards where v falls"
LEAST_ACROSS = 1e-3  # alpha across that direction, as in the sample implementation of glTF

# Alpha of GGX: a narrower lobe is finer than the rounding of a float32 direction, 6e-8.
SMOOTHEST = 1e-8

RADIANCE = "radiance at intensity 1, 0 or more each, from both sides of the surface"


class Surface(Tagged):
    """The base of all materials."""

    type: str = Field(description="the kind of material")

    is_transparent: ClassVar[bool]  # whether it is seen only by light followed through it

    @property
    def emits(self) -> bool:
        """Whether an object of this material is a lamp."""
        return False


def _schema(schema: dict[str, Any]) -> None:
    require_tag(schema)
    in_one_key(schema)


class Opaque(Surface):
    """The base of materials that are seen without following light through them.

    If a key `x` may be a texture, field `x` is its factor, and field `x_map` the texture. A scene
    file has one key for both.
    """

    model_config = ConfigDict(json_schema_extra=_schema)

    color: Color | None = Field(description="share of light that is reflected")
    emission: Annotated[Radiance, Editable(Cost.RECOMPILE)] = Field(
        BLACK, description=f"{RADIANCE}; black: it is no lamp"
    )
    group: Name | None = Field(
        None,
        description="light group whose intensity its emission follows; default: the name of the "
        "material",
    )
    cone: Annotated[Cone | None, Editable(Cost.RECOMPILE)] = Field(
        None,
        description="directions that its emission lights, `{ axis, inner, outer }`; default: all",
    )

    is_transparent = False
    textured: ClassVar[Mapping[str, bool]] = {}  # possible textures; whether of colors

    @model_validator(mode="before")
    @classmethod
    def _has_textures(cls, data: Any) -> Any:
        for name in cls.textured:
            if isinstance(data, Mapping) and isinstance(data.get(f"{name}_map"), Mapping):
                raise ValueError(f"{name}_map is no key; write {name} = {{ image = ... }}")
        return separated(data, cls.textured)

    @model_serializer(mode="wrap")
    def _is_written(self, written: Callable[[Any], dict[str, Any]]) -> dict[str, Any]:
        given = {name: getattr(self, name) for name in self.textured}
        others = {name: value for name, value in given.items() if value not in (1.0, WHITE)}
        return together(written(self), others)

    @property
    def textures(self) -> dict[str, Texture]:
        """Textures of the material, by key."""
        found = {name: value for name, value in self if isinstance(value, Texture)}
        return {name.removesuffix("_map"): texture for name, texture in found.items()}

    def with_images(self, known: Mapping[Any, TextureImage]) -> Self:
        """Return the material with other images in place of its images that are keys of `known`."""
        update = {
            name: texture.model_copy(update={"image": known[texture.image]})
            for name, texture in self
            if isinstance(texture, Texture) and texture.image in known
        }
        return self.model_copy(update=update) if update else self

    @property
    def emits(self) -> bool:
        """Whether its emission is not black."""
        return any(self.emission)


def alpha_of(roughness: float, anisotropy: float = 0.0) -> float:
    """Return the alpha of GGX; 0 if float32 cannot distinguish it from a mirror.

    With anisotropy it is the alpha across the direction of greater roughness, and never 0.
    """
    alpha = roughness**2
    if anisotropy > 0:
        return max(alpha, LEAST_ACROSS)
    return alpha if alpha >= SMOOTHEST else 0.0


def stretch_of(alpha: float, anisotropy: float) -> float:
    """Return alpha in the direction of greater roughness over alpha across it.

    The source is KHR_materials_anisotropy of glTF. The result is 1 where no direction is rougher.
    """
    return (alpha + (1 - alpha) * anisotropy**2) / alpha if anisotropy > 0 else 1.0
