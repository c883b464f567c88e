"""Materials of surfaces: a frozen model for each type.

What the kernel knows of a type stands in shaders_glsl/bsdfs/ and glrt/rendering/pack_materials.py.
docs/extending.md says how a type is added.
"""

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal, Self, get_args

from pydantic import Field, model_validator

from glrt.scene.conductors import PRESETS, Conductor, PresetName
from glrt.scene.cone import Cone
from glrt.scene.values import (
    BLACK,
    WHITE,
    Color,
    Fraction,
    Length,
    Name,
    Number,
    Radiance,
    Tagged,
    Triple,
)
from glrt.settings import Cost, Editable

_Index = Annotated[float, Field(ge=1e-3, le=1e3)]
Indices = tuple[_Index, _Index, _Index]
_Extinction = Annotated[float, Field(ge=0, le=1e3)]
Extinctions = tuple[_Extinction, _Extinction, _Extinction]

# Alpha of GGX: a narrower lobe is finer than the rounding of a float32 direction, 6e-8.
SMOOTHEST = 1e-8
# Share of light that is left of a channel which attenuation_color says is black.
LEAST_LEFT = 1e-12


_RADIANCE = "radiance at intensity 1, 0 or more each, from both sides of the surface"


class Surface(Tagged):
    """What every material has."""

    type: str = Field(description="the kind of material")

    is_transparent: ClassVar[bool]  # nothing is seen of it but by following light through it

    @property
    def emits(self) -> bool:
        """Whether an object of this material is a lamp."""
        return False


class Opaque(Surface):
    """What every material has that light does not pass."""

    color: Color | None = Field(description="share of light that is reflected")
    emission: Annotated[Radiance, Editable(Cost.RECOMPILE)] = Field(
        BLACK, description=f"{_RADIANCE}; black: it is no lamp"
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

    @property
    def emits(self) -> bool:
        """Whether some of its emission is not black."""
        return any(self.emission)


def _alpha(roughness: float) -> float:
    alpha = roughness**2
    return alpha if alpha >= SMOOTHEST else 0.0


class Lambertian(Opaque):
    """A matte (Lambertian) surface."""

    type: Literal["lambertian"] = Field("lambertian", description="the kind of material")
    color: Color = Field(description="albedo, 0 to 1 each")

    if TYPE_CHECKING:

        def __init__(
            self,
            *,
            color: Triple,
            emission: Triple = BLACK,
            group: str | None = None,
            cone: Cone | Mapping[str, Any] | None = None,
        ) -> None: ...


class Metal(Opaque):
    """Metal, smooth or rough (GGX), of a color, or with the reflectance of a measured metal.

    Exactly one of `color`, `preset`, and `ior` with `k` says what it reflects.
    """

    type: Literal["metal"] = Field("metal", description="the kind of material")
    color: Color | None = Field(
        None, description="reflectance, the same at all angles, 0 to 1 each"
    )
    preset: PresetName | None = Field(None, description="name of a measured metal")
    ior: Indices | None = Field(
        None, description="index of refraction in red, green and blue, with `k`"
    )
    k: Extinctions | None = Field(
        None, description="extinction coefficient in red, green and blue, with `ior`"
    )
    roughness: Annotated[Fraction, Editable(Cost.RECOMPILE)] = Field(
        0.0,
        description="0: a mirror; the alpha of GGX is its square",
    )

    if TYPE_CHECKING:

        def __init__(
            self,
            *,
            color: Triple | None = None,
            preset: PresetName | None = None,
            ior: Triple | None = None,
            k: Triple | None = None,
            roughness: Number = 0.0,
            emission: Triple = BLACK,
            group: str | None = None,
            cone: Cone | Mapping[str, Any] | None = None,
        ) -> None: ...

    @model_validator(mode="after")
    def _reflects_in_one_way(self) -> Self:
        ways = self.color is not None, self.preset is not None, self.ior is not None
        if sum(ways) != 1 or (self.ior is None) != (self.k is None):
            raise ValueError(
                "must say what it reflects in one way: by color, by preset, or by ior and k"
            )
        return self

    @property
    def conductor(self) -> Conductor | None:
        """Its complex index of refraction; None for one of a color."""
        if self.preset is not None:
            return PRESETS[self.preset]
        if self.ior is None or self.k is None:
            return None
        return Conductor(self.ior, self.k)

    @property
    def head_on(self) -> Color:
        """Reflectance at normal incidence."""
        return self.conductor.head_on if self.conductor else self.color or BLACK

    @property
    def alpha(self) -> float:
        """The alpha of GGX; 0 for a mirror, and for what a float32 cannot tell from one."""
        return _alpha(self.roughness)


class Dielectric(Surface):
    """Glass or liquid, smooth or rough (GGX), with exact unpolarised Fresnel reflection."""

    type: Literal["dielectric"] = Field("dielectric", description="the kind of material")
    is_transparent = True
    ior: Annotated[Length, Editable(slider=(1, 3))] = Field(
        1.5,
        description="index of refraction, inside over outside",
    )
    roughness: Annotated[Fraction, Editable(Cost.RECOMPILE)] = Field(
        0.0,
        description="0: smooth; the alpha of GGX is its square",
    )
    attenuation_color: Annotated[Color | None, Editable(Cost.RECOMPILE)] = Field(
        None,
        description="share of white light that is left after `attenuation_distance`; default: all",
    )
    attenuation_distance: Annotated[Length | None, Editable(Cost.RECOMPILE)] = Field(
        None,
        description="length inside after which light has the `attenuation_color` (Beer's law)",
    )
    thin: Annotated[bool, Editable(Cost.RECOMPILE)] = Field(
        False,
        description="whether the surface is a pane, both faces at once: light passes it straight",
    )
    priority: Annotated[int | None, Field(ge=-1000, le=1000), Editable(Cost.RECOMPILE)] = Field(
        None,
        description="where glasses with a priority overlap, the one of the highest is there, and "
        "`ior` is against air; default: glass does not nest",
    )

    if TYPE_CHECKING:

        def __init__(
            self,
            *,
            ior: Number = 1.5,
            roughness: Number = 0.0,
            attenuation_color: Triple | None = None,
            attenuation_distance: Number | None = None,
            thin: bool = False,
            priority: int | None = None,
        ) -> None: ...

    @model_validator(mode="after")
    def _attenuates_by_a_distance(self) -> Self:
        if (self.attenuation_color is None) != (self.attenuation_distance is None):
            raise ValueError(
                "attenuation_color and attenuation_distance go together; give both, or neither"
            )
        return self

    @model_validator(mode="after")
    def _is_simple_where_it_must_be(self) -> Self:
        if self.thin:
            has = {
                "roughness": self.roughness > 0,
                "attenuation_distance": self.attenuation_distance is not None,
                "priority": self.priority is not None,
            }
            for key in (key for key, is_given in has.items() if is_given):
                raise ValueError(f"a thin pane has no {key}; leave that out, or thin")
        if self.priority is not None and self.roughness > 0:
            raise ValueError("rough glass has no priority; leave one of the two out")
        return self

    @property
    def alpha(self) -> float:
        """The alpha of GGX; 0 where it is smooth, or as good as that for a float32.

        Refraction spreads light over an angle of about alpha times (ior - 1).
        """
        alpha = self.roughness**2
        return alpha if alpha * min(1.0, abs(self.ior - 1)) >= SMOOTHEST else 0.0

    @property
    def has_details(self) -> bool:
        """Whether it is more than clear and smooth."""
        return self.alpha > 0 or any(self.absorption) or self.priority is not None

    @property
    def absorption(self) -> Color:
        """Share of light that is absorbed in a short length, over that length, in each channel."""
        if self.attenuation_color is None or self.attenuation_distance is None:
            return BLACK
        red, green, blue = (
            -math.log(max(share, LEAST_LEFT)) / self.attenuation_distance + 0.0
            for share in self.attenuation_color
        )
        return red, green, blue


class Principled(Opaque):
    """glTF's metallic-roughness surface: a coat, over metal and dielectric facets, over matte.

    Facets are GGX with Schlick's reflectance. docs/explanation/principled.md tells the formulas.
    """

    type: Literal["principled"] = Field("principled", description="the kind of material")
    color: Color = Field(WHITE, description="albedo of the base, and reflectance of what is metal")
    metallic: Annotated[Fraction, Editable()] = Field(
        0.0, description="share of the surface that is metal"
    )
    roughness: Annotated[Fraction, Editable()] = Field(
        0.4, description="of metal and dielectric; 0: smooth; the alpha of GGX is its square"
    )
    ior: Annotated[float, Field(ge=1, le=1e3), Editable(slider=(1, 3))] = Field(
        1.5, description="index of refraction of what is no metal"
    )
    specular: Annotated[Fraction, Editable()] = Field(
        1.0, description="factor of what is reflected by what is no metal"
    )
    specular_color: Annotated[Color, Editable()] = Field(
        WHITE, description="factor of the same, head-on"
    )
    clearcoat: Annotated[Fraction, Editable(Cost.RECOMPILE)] = Field(
        0.0, description="weight of a clear coat of index 1.5"
    )
    clearcoat_roughness: Annotated[Fraction, Editable()] = Field(
        0.1, description="of the coat; 0: smooth; the alpha of GGX is its square"
    )

    if TYPE_CHECKING:

        def __init__(
            self,
            *,
            color: Triple = WHITE,
            metallic: Number = 0.0,
            roughness: Number = 0.4,
            ior: Number = 1.5,
            specular: Number = 1.0,
            specular_color: Triple = WHITE,
            clearcoat: Number = 0.0,
            clearcoat_roughness: Number = 0.1,
            emission: Triple = BLACK,
            group: str | None = None,
            cone: Cone | Mapping[str, Any] | None = None,
        ) -> None: ...

    @property
    def alpha(self) -> float:
        """The alpha of GGX; 0 where a float32 cannot tell."""
        return _alpha(self.roughness)

    @property
    def coat_alpha(self) -> float:
        """The same of the coat."""
        return _alpha(self.clearcoat_roughness)

    @property
    def head_on(self) -> Color:
        """Reflectance at normal incidence of what is no metal: f0."""
        share = ((self.ior - 1) / (self.ior + 1)) ** 2
        red, green, blue = (min(share * tint, 1) * self.specular for tint in self.specular_color)
        return red, green, blue


class Light(Opaque):
    """An area light, evenly bright in all directions unless it has a cone."""

    type: Literal["light"] = Field("light", description="the kind of material")
    color: Color = Field(BLACK, description="albedo of the lamp itself")
    emission: Radiance = Field(description=_RADIANCE)

    if TYPE_CHECKING:

        def __init__(
            self,
            *,
            emission: Triple,
            color: Triple = BLACK,
            group: str | None = None,
            cone: Cone | Mapping[str, Any] | None = None,
        ) -> None: ...

    @property
    def emits(self) -> bool:
        """It stays a lamp where its emission is black."""
        return True


Material = Annotated[
    Lambertian | Metal | Dielectric | Principled | Light, Field(discriminator="type")
]

TYPES: dict[str, Any] = {  # the model of each type
    model.model_fields["type"].default: model for model in get_args(get_args(Material)[0])
}
