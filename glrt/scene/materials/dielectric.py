"""Glass and liquids."""

import math
from typing import TYPE_CHECKING, Annotated, Literal, Self

from pydantic import Field, model_validator

from glrt.scene.materials.base import SMOOTHEST, Surface
from glrt.scene.values import BLACK, Color, Fraction, Length, Number, Triple
from glrt.settings import Cost, Editable

# Share of light that is left of a channel that is black in attenuation_color.
LEAST_LEFT = 1e-12


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
        """The alpha of GGX; 0 if it is smooth, or if float32 cannot distinguish it from smooth.

        Refraction spreads light over an angle of about alpha times (ior - 1).
        """
        alpha = self.roughness**2
        return alpha if alpha * min(1.0, abs(self.ior - 1)) >= SMOOTHEST else 0.0

    @property
    def has_details(self) -> bool:
        """Whether it is rough, tinted, or has a priority."""
        return self.alpha > 0 or any(self.absorption) or self.priority is not None

    @property
    def absorption(self) -> Color:
        """Absorption coefficient of each channel, per scene unit."""
        if self.attenuation_color is None or self.attenuation_distance is None:
            return BLACK
        red, green, blue = (
            -math.log(max(share, LEAST_LEFT)) / self.attenuation_distance + 0.0
            for share in self.attenuation_color
        )
        return red, green, blue
