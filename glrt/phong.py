"""Constants of Phong's model: the table `[render.phong]` of scene files."""

from typing import Annotated, Self

from pydantic import Field, model_validator

from glrt.editable import Cost, Editable, Frozen


class Phong(Frozen):
    """Constants of Phong's model, for all surfaces: the scene's `[render.phong]` table.

    With C, the colour of a surface, N.L, the cosine of the light, and E, the irradiance of a lamp:
    ambient C + sum over lamps of E / pi (diffuse C N.L + specular highlight^exponent). Source:
    Whitted 1980, eq. 1; the thesis, Appendix A.
    """

    ambient: Annotated[float | None, Editable(Cost.RESTART, "radiance", (0, 1))] = Field(
        None,
        description="radiance that a white surface sends without any lamp; default: that of the "
        "background's light",
        ge=0,
        le=1e15,
    )
    diffuse: Annotated[float | None, Editable(Cost.RESTART, "", (0, 1))] = Field(
        None,
        description="share of its colour that a surface reflects evenly; default: as the material "
        "does, 1 for matte surfaces and 0 for metal",
        ge=0,
        le=1000,
    )
    specular: Annotated[float | None, Editable(Cost.RESTART, "", (0, 1))] = Field(
        None,
        description="strength of white highlights, which shine as a white matte surface at 1; "
        "given together with `exponent`; default: highlights of the material, by its roughness",
        ge=0,
        le=1000,
    )
    exponent: Annotated[int | None, Editable(Cost.RESTART, "", (1, 1000))] = Field(
        None,
        description="sharpness of the highlights, a whole number; around the half vector (blinn) "
        "4 times that around the mirrored direction (phong) is as wide",
        ge=0,
        le=1 << 24,
    )

    @property
    def is_given(self) -> bool:
        """Whether it replaces anything that materials have."""
        return any(value is not None for _, value in self)

    @model_validator(mode="after")
    def _highlights_are_whole(self) -> Self:
        if (self.specular is None) != (self.exponent is None):
            given, missing = ("specular", "exponent")[:: 1 if self.exponent is None else -1]
            raise ValueError(
                f"{given} is given without {missing}: a highlight needs both; give {missing} too, "
                f"or leave out {given}"
            )
        return self
