"""glTF's metallic-roughness surface."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal, Self

from pydantic import BeforeValidator, Field, model_validator

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
from glrt.scene.materials.dielectric import DISPERSION, Dielectric, Dispersion
from glrt.scene.materials.textures import NormalTexture, Texture, data_texture
from glrt.scene.materials.thin_film import ThinFilm
from glrt.scene.values import BLACK, WHITE, Color, Fraction, Length, Number, Triple
from glrt.settings import Cost, Editable


class Principled(Opaque):
    """glTF's metallic-roughness surface: a coat, over metal and dielectric facets, over matte.

    Facets are GGX with Schlick's reflectance. docs/explanation/principled.md has the formulas.
    Color, emission, metallic, roughness, alpha and transmission may be textures.
    """

    type: Literal["principled"] = Field("principled", description="the kind of material")
    color: Color = Field(WHITE, description="albedo of the base, and reflectance of what is metal")
    metallic: Annotated[Fraction, Editable()] = Field(
        0.0, description="share of the surface that is metal"
    )
    roughness: Annotated[Fraction, Editable()] = Field(
        0.4, description="of metal and dielectric; 0: smooth; the alpha of GGX is its square"
    )
    anisotropy: Anisotropy = Field(0.0, description=f"{ANISOTROPY}; not with transmission")
    anisotropy_rotation: Rotation = Field(0.0, description=ROTATION)
    ior: Annotated[float, Field(ge=1, le=1e3), Editable(slider=(1, 3))] = Field(
        1.5, description="index of refraction of what is no metal"
    )
    specular: Annotated[Fraction, Editable()] = Field(
        1.0, description="factor of what is reflected by what is no metal"
    )
    specular_color: Annotated[Color, Editable()] = Field(
        WHITE, description="factor of the same, head-on"
    )
    transmission: Annotated[Fraction, Editable(Cost.RECOMPILE)] = Field(
        0.0, description="share of what is no metal that is glass in place of matte, of its color"
    )
    attenuation_color: Annotated[Color | None, Editable(Cost.RECOMPILE)] = Field(
        None, description="of the glass, as for the type dielectric"
    )
    attenuation_distance: Annotated[Length | None, Editable(Cost.RECOMPILE)] = Field(
        None, description="of the glass, as for the type dielectric"
    )
    dispersion: Dispersion = Field(0.0, description=f"{DISPERSION}; with transmission")
    thin: Annotated[bool, Editable(Cost.RECOMPILE)] = Field(
        False, description="whether its glass is a pane: both faces at once"
    )
    alpha: Annotated[Fraction, Editable(Cost.RECOMPILE)] = Field(
        1.0,
        description="share of the surface that is there; light passes the rest; not of lamps",
    )
    clearcoat: Annotated[Fraction, Editable(Cost.RECOMPILE)] = Field(
        0.0, description="weight of a clear coat of index 1.5; not with transmission"
    )
    clearcoat_roughness: Annotated[Fraction, Editable()] = Field(
        0.1, description="of the coat; 0: smooth; the alpha of GGX is its square"
    )
    normal: Annotated[NormalTexture | None, BeforeValidator(data_texture)] = Field(
        None, description="an image of normals in tangent space, `{ image, strength }`"
    )
    alpha_cutoff: Annotated[Fraction | None, Editable()] = Field(
        None, description="the surface is there where alpha is at least this, and nowhere else"
    )
    iridescence: Annotated[Fraction, Editable(Cost.RECOMPILE)] = Field(
        0.0, description="share under a thin film in the colors of soap; not with transmission"
    )
    iridescence_ior: Annotated[float, Field(ge=1, le=10), Editable(slider=(1, 3))] = Field(
        1.3, description="index of refraction of the film"
    )
    iridescence_thickness: Annotated[
        float, Field(ge=0, le=1e4), Editable(unit="nm", slider=(0, 1200))
    ] = Field(400.0, description="thickness of the film, in nanometres")
    sheen: Annotated[Color, Editable(Cost.RECOMPILE)] = Field(
        BLACK,
        description="color of fibres, as of cloth, seen at the edge; not with transmission",
    )
    sheen_roughness: Annotated[Fraction, Editable()] = Field(
        0.3, description="of sheen; its alpha is the square, at least 0.01"
    )
    diffuse_transmission: Annotated[Fraction, Editable(Cost.RECOMPILE)] = Field(
        0.0,
        description="share of the matte base that lets light through and scatters it, as leaves "
        "and paper do; not with transmission",
    )
    diffuse_transmission_color: Annotated[Color, Editable()] = Field(
        WHITE, description="of the light that it lets through"
    )
    color_map: Texture | None = None
    emission_map: Texture | None = None
    metallic_map: Texture | None = None
    roughness_map: Texture | None = None
    alpha_map: Texture | None = None
    transmission_map: Texture | None = None

    textured: ClassVar[Mapping[str, bool]] = {
        "color": True,
        "emission": True,
        "metallic": False,
        "roughness": False,
        "alpha": False,
        "transmission": False,
    }

    if TYPE_CHECKING:

        def __init__(
            self,
            *,
            color: Triple | Texture = WHITE,
            metallic: Number | Texture = 0.0,
            roughness: Number | Texture = 0.4,
            anisotropy: Number = 0.0,
            anisotropy_rotation: Number = 0.0,
            ior: Number = 1.5,
            specular: Number = 1.0,
            specular_color: Triple = WHITE,
            transmission: Number | Texture = 0.0,
            attenuation_color: Triple | None = None,
            attenuation_distance: Number | None = None,
            dispersion: Number = 0.0,
            thin: bool = False,
            alpha: Number | Texture = 1.0,
            clearcoat: Number = 0.0,
            clearcoat_roughness: Number = 0.1,
            normal: NormalTexture | Mapping[str, Any] | None = None,
            alpha_cutoff: Number | None = None,
            iridescence: Number = 0.0,
            iridescence_ior: Number = 1.3,
            iridescence_thickness: Number = 400.0,
            sheen: Triple = BLACK,
            sheen_roughness: Number = 0.3,
            diffuse_transmission: Number = 0.0,
            diffuse_transmission_color: Triple = WHITE,
            emission: Triple | Texture = BLACK,
            group: str | None = None,
            cone: Cone | Mapping[str, Any] | None = None,
        ) -> None: ...

    @property
    def facet_alpha(self) -> float:
        """The alpha of GGX of the facets; 0 if float32 cannot distinguish it from smooth."""
        return alpha_of(self.roughness, self.anisotropy)

    @property
    def stretch(self) -> float:
        """Alpha in the direction of greater roughness over alpha across it; 1: alike all round."""
        return stretch_of(self.facet_alpha, self.anisotropy)

    @property
    def film(self) -> ThinFilm | None:
        """The thin film on its facets; None if it has none."""
        if not self.iridescence:
            return None
        return ThinFilm(self.iridescence_ior, self.iridescence_thickness)

    @model_validator(mode="after")
    def _has_glass_that_can_be(self) -> Self:
        if self.transmission > 0 and self.clearcoat > 0:
            raise ValueError("a coat over transmission is not known; leave one of the two out")
        if self.anisotropy > 0 and self.transmission > 0:
            raise ValueError("anisotropy of glass is not known; leave it or transmission out")
        if self.iridescence > 0 and self.transmission > 0:
            raise ValueError("iridescence of glass is not known; leave it or transmission out")
        if any(self.sheen) and self.transmission > 0:
            raise ValueError("sheen of glass is not known; leave it or transmission out")
        if self.diffuse_transmission > 0 and self.transmission > 0:
            raise ValueError("diffuse_transmission of glass is not known; leave one of the two out")
        if self.anisotropy > 0 and self.roughness_map:
            raise ValueError("roughness as a texture with anisotropy is not known; give a number")
        if self.has_holes and self.emits and not (self.is_unlit or self.emission_map):
            raise ValueError("a lamp has no alpha; leave alpha or emission out")
        if self.metallic_map and self.transmission > 0:
            raise ValueError("metallic as a texture with transmission is not known; give a number")
        _ = self.glass  # raises for values that do not fit
        return self

    @property
    def glass(self) -> Dielectric | None:
        """The glass part, without the color that tints crossing light; None if it is opaque."""
        if not self.transmission:
            return None
        return Dielectric(
            ior=self.ior,
            roughness=self.roughness,
            attenuation_color=self.attenuation_color,
            attenuation_distance=self.attenuation_distance,
            dispersion=self.dispersion,
            thin=self.thin,
        )

    @property
    def is_unlit(self) -> bool:
        """Whether it shows its emission and reflects nothing, as in KHR_materials_unlit."""
        scatters = any(self.color) or self.specular or any(self.sheen) or self.diffuse_transmission
        return self.emits and not scatters

    @property
    def is_matte(self) -> bool:
        """Whether it scatters as a Lambertian surface does: no metal, facets, glass or coat."""
        layers = self.transmission or self.clearcoat or any(self.sheen) or self.diffuse_transmission
        return not (self.metallic or self.specular or layers)

    @property
    def has_holes(self) -> bool:
        """Whether light passes the surface partly, or in places."""
        return self.alpha_map is not None or self.coverage < 1

    @property
    def coverage(self) -> float:
        """Share of the surface that is there, or the factor of an alpha texture."""
        if self.alpha_cutoff is None or self.alpha_map is not None:
            return self.alpha
        return 1.0 if self.alpha >= self.alpha_cutoff else 0.0

    @property
    def glass_share(self) -> float:
        """Share of the surface that is glass."""
        return (1 - self.metallic) * self.transmission

    @property
    def coat_alpha(self) -> float:
        """The alpha of GGX of the coat; 0 if float32 cannot distinguish it from smooth."""
        return alpha_of(self.clearcoat_roughness)

    @property
    def head_on(self) -> Color:
        """Reflectance f0 of the part that is no metal, at normal incidence."""
        share = ((self.ior - 1) / (self.ior + 1)) ** 2
        red, green, blue = (min(share * tint, 1) * self.specular for tint in self.specular_color)
        return red, green, blue
