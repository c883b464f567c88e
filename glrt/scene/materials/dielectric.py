"""Glass and liquids."""

import math
from typing import TYPE_CHECKING, Annotated, Literal, Self

from pydantic import Field, model_validator

from glrt.scene.materials.base import SMOOTHEST, Surface
from glrt.scene.values import BLACK, Color, Fraction, Length, Number, Triple
from glrt.settings import Cost, Editable

# Share of light that is left of a channel that is black in attenuation_color.
LEAST_LEFT = 1e-12

Dispersion = Annotated[float, Field(ge=0, le=10), Editable(Cost.RECOMPILE, slider=(0, 2))]
DISPERSION = "of smooth glass: 20 over its Abbe number; 0: all colors refract alike"


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
    dispersion: Dispersion = Field(0.0, description=DISPERSION)
    thin: Annotated[bool, Editable(Cost.RECOMPILE)] = Field(
        False,
        description="whether the surface is a pane, both faces at once: light passes a smooth one "
        "straight",
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
            dispersion: Number = 0.0,
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
                "attenuation_distance": self.attenuation_distance is not None,
                "priority": self.priority is not None,
                "dispersion": self.dispersion > 0,
            }
            for key in (key for key, is_given in has.items() if is_given):
                raise ValueError(f"a thin pane has no {key}; leave that out, or thin")
        if self.dispersion > 0:
            self._disperses_as_known()
        return self

    def _disperses_as_known(self) -> None:
        if self.roughness > 0:
            raise ValueError("rough glass has no dispersion; give roughness = 0, or leave it out")
        if self.priority is not None:
            raise ValueError("dispersion with a priority is not known; leave one of the two out")
        if self.ior < 1:
            raise ValueError("dispersion needs an ior of at least 1; leave one of the two out")

    @property
    def alpha(self) -> float:
        """The alpha of GGX; 0 if it is smooth, or if float32 cannot distinguish it from smooth.

        Refraction spreads light over an angle of about alpha times (ior - 1), and a pane over
        alpha. For glass with a priority the kernel decides, as it knows what lies around the glass.
        """
        alpha = self.roughness**2
        is_known = not self.thin and self.priority is None
        spread = min(1.0, abs(self.ior - 1)) if is_known else 1.0
        return alpha if alpha * spread >= SMOOTHEST else 0.0

    @property
    def spread(self) -> float:
        """Index of refraction at the F line minus that at the C line: (ior - 1) / Abbe number."""
        return (self.ior - 1) * self.dispersion / 20

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
