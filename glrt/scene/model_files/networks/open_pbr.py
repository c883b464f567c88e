"""OpenPBR Surface as a principled material: https://academysoftwarefoundation.github.io/OpenPBR/."""

import math

from glrt.scene.model_files.networks.inputs import Defaults, Inputs
from glrt.scene.model_files.networks.layered import (
    base_color,
    coated,
    emission,
    facets,
    fibres,
    film,
    glass,
    opacity,
    weighted,
)
from glrt.scene.model_files.networks.nodes import Table

DEFAULTS: Defaults = {
    "base_weight": 1.0,
    "base_color": (0.8, 0.8, 0.8),
    "base_diffuse_roughness": 0.0,
    "base_metalness": 0.0,
    "specular_weight": 1.0,
    "specular_color": (1.0, 1.0, 1.0),
    "specular_roughness": 0.3,
    "specular_ior": 1.5,
    "specular_roughness_anisotropy": 0.0,
    "transmission_weight": 0.0,
    "transmission_color": (1.0, 1.0, 1.0),
    "transmission_depth": 0.0,
    "transmission_scatter": (0.0, 0.0, 0.0),
    "transmission_dispersion_scale": 0.0,
    "transmission_dispersion_abbe_number": 20.0,
    "subsurface_weight": 0.0,
    "subsurface_color": (0.8, 0.8, 0.8),
    "fuzz_weight": 0.0,
    "fuzz_color": (1.0, 1.0, 1.0),
    "fuzz_roughness": 0.5,
    "coat_weight": 0.0,
    "coat_color": (1.0, 1.0, 1.0),
    "coat_roughness": 0.0,
    "coat_roughness_anisotropy": 0.0,
    "coat_ior": 1.6,
    "coat_darkening": 1.0,
    "thin_film_weight": 0.0,
    "thin_film_thickness": 0.5,
    "thin_film_ior": 1.4,
    "emission_luminance": 0.0,
    "emission_color": (1.0, 1.0, 1.0),
    "geometry_opacity": 1.0,
    "geometry_thin_walled": 0.0,
}
_GLASS = {
    "weight": "transmission_weight",
    "color": "transmission_color",
    "depth": "transmission_depth",
    "scatter": "transmission_scatter",
}
_NANOMETRES = 1e3  # of a micrometre


def open_pbr(inputs: Inputs) -> Table:
    """Return the table of a material."""
    inputs.report("base_diffuse_roughness", "coat_roughness_anisotropy")
    inputs.report_vectors("geometry_coat_normal", "geometry_tangent", "geometry_coat_tangent")
    base = weighted(inputs, "base_weight", "base_color")
    is_thin = bool(inputs.number("geometry_thin_walled"))
    leaf: Table = {}
    if is_thin and inputs.has("subsurface_weight"):
        leaf = _leaf(inputs)
    else:
        base = base_color(inputs, base, "subsurface_weight", "subsurface_color")
    base = coated(inputs, "coat_weight", "coat_color", base)
    metal = inputs.found("base_metalness")
    table: Table = {"metallic": inputs.number_key(metal, "base_metalness")}
    table |= facets(inputs, "specular_roughness", "specular_roughness_anisotropy", _alphas)
    table["specular"] = inputs.number("specular_weight")
    table["specular_color"] = list(inputs.three("specular_color"))
    table["ior"] = inputs.number("specular_ior", 1e3, 1.0)
    table |= glass(inputs, _GLASS, base, is_thin) | leaf
    if scale := inputs.number("transmission_dispersion_scale"):
        abbe = inputs.number("transmission_dispersion_abbe_number", 1e9)
        table["dispersion"] = min(20 * scale / max(abbe, 1e-3), 10.0)
    if inputs.has("coat_weight"):
        table["clearcoat"] = inputs.number("coat_weight")
        table["clearcoat_roughness"] = inputs.number("coat_roughness")
        if inputs.number("coat_ior", 1e3) != 1.5:
            inputs.left.add("coat_ior other than 1.5")
        inputs.left.add("coat_darkening")
    if weight := inputs.number("thin_film_weight"):
        thickness = inputs.number("thin_film_thickness", 10.0) * _NANOMETRES
        table |= film(thickness, inputs.number("thin_film_ior", 10.0, 1.0), weight)
    table |= fibres(inputs, "fuzz_weight", "fuzz_color", "fuzz_roughness")
    table |= emission(inputs, "emission_luminance", "emission_color")
    table |= opacity(inputs, "geometry_opacity")
    if normal := inputs.normal_key("geometry_normal"):
        table["normal"] = normal
    return table


def _leaf(inputs: Inputs) -> Table:
    """Return the keys of a thin wall that scatters light to both sides alike."""
    share = inputs.number("subsurface_weight")
    color = list(inputs.three("subsurface_color"))
    return {"diffuse_transmission": share / 2, "diffuse_transmission_color": color}


def _alphas(roughness: float, anisotropy: float) -> tuple[float, float]:
    """Return the alphas of GGX along and across the grain: OpenPBR 1.1, "Microfacet model"."""
    along = roughness**2 * math.sqrt(2 / (1 + (1 - anisotropy) ** 2))
    return along, (1 - anisotropy) * along
