"""Metals."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal, Self

from pydantic import Field, model_validator

from glrt.scene.lights.cone import Cone
from glrt.scene.materials.base import (
    ANISOTROPY,
    ROTATION,
    Anisotropy,
    Opaque,
    Rotation,
    alpha_of,
    stretch_of,
)
from glrt.scene.materials.conductors import PRESETS, Conductor, PresetName
from glrt.scene.materials.textures import Texture
from glrt.scene.values import BLACK, Color, Fraction, Number, Triple
from glrt.settings import Cost, Editable

_Index = Annotated[float, Field(ge=1e-3, le=1e3)]
Indices = tuple[_Index, _Index, _Index]
_Extinction = Annotated[float, Field(ge=0, le=1e3)]
Extinctions = tuple[_Extinction, _Extinction, _Extinction]


class Metal(Opaque):
    """Metal, smooth or rough (GGX), with a color or with the reflectance of a measured metal.

    Exactly one of `color`, `preset`, and `ior` with `k` gives its reflectance.
    """

    type: Literal["metal"] = Field("metal", description="the kind of material")
    color: Color | None = Field(
        None, description="reflectance, the same at all angles, 0 to 1 each, or a texture"
    )
    color_map: Texture | None = None
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
    anisotropy: Anisotropy = Field(0.0, description=ANISOTROPY)
    anisotropy_rotation: Rotation = Field(0.0, description=ROTATION)

    textured: ClassVar[Mapping[str, bool]] = {"color": True}

    if TYPE_CHECKING:

        def __init__(
            self,
            *,
            color: Triple | Texture | None = None,
            preset: PresetName | None = None,
            ior: Triple | None = None,
            k: Triple | None = None,
            roughness: Number = 0.0,
            anisotropy: Number = 0.0,
            anisotropy_rotation: Number = 0.0,
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
        """Complex index of refraction; None for a metal given by a color."""
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
        """The alpha of GGX; 0 for a mirror, and if float32 cannot distinguish it from one."""
        return alpha_of(self.roughness, self.anisotropy)

    @property
    def stretch(self) -> float:
        """Alpha in the direction of greater roughness over alpha across it; 1: alike all round."""
        return stretch_of(self.alpha, self.anisotropy)
