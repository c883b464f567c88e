"""Autodesk's Standard Surface as a principled material: https://autodesk.github.io/standard-surface/."""

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
    "base": 1.0,
    "base_color": (0.8, 0.8, 0.8),
    "diffuse_roughness": 0.0,
    "metalness": 0.0,
    "specular": 1.0,
    "specular_color": (1.0, 1.0, 1.0),
    "specular_roughness": 0.2,
    "specular_IOR": 1.5,
    "specular_anisotropy": 0.0,
    "specular_rotation": 0.0,
    "transmission": 0.0,
    "transmission_color": (1.0, 1.0, 1.0),
    "transmission_depth": 0.0,
    "transmission_scatter": (0.0, 0.0, 0.0),
    "transmission_dispersion": 0.0,
    "transmission_extra_roughness": 0.0,
    "subsurface": 0.0,
    "subsurface_color": (1.0, 1.0, 1.0),
    "sheen": 0.0,
    "sheen_color": (1.0, 1.0, 1.0),
    "sheen_roughness": 0.3,
    "coat": 0.0,
    "coat_color": (1.0, 1.0, 1.0),
    "coat_roughness": 0.1,
    "coat_anisotropy": 0.0,
    "coat_IOR": 1.5,
    "coat_affect_color": 0.0,
    "coat_affect_roughness": 0.0,
    "thin_film_thickness": 0.0,
    "thin_film_IOR": 1.5,
    "emission": 0.0,
    "emission_color": (1.0, 1.0, 1.0),
    "opacity": (1.0, 1.0, 1.0),
    "thin_walled": 0.0,
}
_GLASS = {
    "weight": "transmission",
    "color": "transmission_color",
    "depth": "transmission_depth",
    "scatter": "transmission_scatter",
}
_WITHOUT_COUNTERPART = (
    "diffuse_roughness",
    "transmission_extra_roughness",
    "coat_anisotropy",
    "coat_affect_color",
    "coat_affect_roughness",
)
_TURN = 360.0  # degrees of a rotation of 1


def standard_surface(inputs: Inputs) -> Table:
    """Return the table of a material."""
    inputs.report(*_WITHOUT_COUNTERPART)
    inputs.report_vectors("coat_normal", "tangent")
    base = weighted(inputs, "base", "base_color")
    base = base_color(inputs, base, "subsurface", "subsurface_color")
    base = coated(inputs, "coat", "coat_color", base)
    is_thin = bool(inputs.number("thin_walled"))
    table: Table = {"metallic": inputs.number_key(inputs.found("metalness"), "metalness")}
    table |= facets(inputs, "specular_roughness", "specular_anisotropy", _alphas)
    if "anisotropy" in table:
        table["anisotropy_rotation"] = inputs.number("specular_rotation") * _TURN
    table["specular"] = inputs.number("specular")
    table["specular_color"] = list(inputs.three("specular_color"))
    table["ior"] = inputs.number("specular_IOR", 1e3, 1.0)
    table |= glass(inputs, _GLASS, base, is_thin)
    if abbe := inputs.number("transmission_dispersion", 1e9):
        table["dispersion"] = min(20 / abbe, 10.0)
    if inputs.has("coat"):
        table["clearcoat"] = inputs.number("coat")
        table["clearcoat_roughness"] = inputs.number("coat_roughness")
        inputs.report("coat_IOR")
    thickness = inputs.number("thin_film_thickness", 1e4)
    table |= film(thickness, inputs.number("thin_film_IOR", 10.0, 1.0), 1.0)
    table |= fibres(inputs, "sheen", "sheen_color", "sheen_roughness")
    table |= emission(inputs, "emission", "emission_color")
    table |= opacity(inputs, "opacity")
    if normal := inputs.normal_key("normal"):
        table["normal"] = normal
    return table


def _alphas(roughness: float, anisotropy: float) -> tuple[float, float]:
    """Return the alphas of GGX along and across the grain: roughness_anisotropy of MaterialX."""
    aspect = math.sqrt(1 - min(anisotropy, 0.98))
    return min(roughness**2 / aspect, 1.0), roughness**2 * aspect
