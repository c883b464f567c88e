"""UsdPreviewSurface as a principled material.

https://openusd.org/release/spec_usdpreviewsurface.html
"""

import math

from glrt.scene.model_files.networks.inputs import BRIGHTEST, Defaults, Inputs
from glrt.scene.model_files.networks.nodes import Table

DEFAULTS: Defaults = {
    "diffuseColor": (0.18, 0.18, 0.18),
    "emissiveColor": (0.0, 0.0, 0.0),
    "useSpecularWorkflow": 0.0,
    "specularColor": (0.0, 0.0, 0.0),
    "metallic": 0.0,
    "roughness": 0.5,
    "clearcoat": 0.0,
    "clearcoatRoughness": 0.01,
    "opacity": 1.0,
    "opacityThreshold": 0.0,
    "ior": 1.5,
}
_LARGEST_F0 = 0.99  # of an index of refraction of 399


def preview_surface(inputs: Inputs) -> Table:
    """Return the table of a material."""
    table: Table = {"color": inputs.color_key(inputs.found("diffuseColor"), "diffuseColor")}
    for name in ("metallic", "roughness"):
        table[name] = inputs.number_key(inputs.found(name), name)
    table["clearcoat"] = inputs.number("clearcoat")
    table["clearcoat_roughness"] = inputs.number("clearcoatRoughness")
    table["ior"] = inputs.number("ior", 1e3, 1.0)
    if inputs.number("useSpecularWorkflow"):
        table |= _specular(inputs)
    emission = inputs.color_key(inputs.found("emissiveColor"), "emissiveColor", BRIGHTEST)
    if isinstance(emission, dict) or any(emission):
        table["emission"] = emission
    alpha = inputs.number_key(inputs.found("opacity"), "opacity")
    if alpha != 1.0:
        table["alpha"] = alpha
        if (cutoff := inputs.number("opacityThreshold")) > 0:
            table["alpha_cutoff"] = cutoff
    if normal := inputs.normal_key("normal"):
        table["normal"] = normal
    return table


def _specular(inputs: Inputs) -> Table:
    """Return the keys that give a color as reflectance head-on, in place of ior and metallic."""
    color = inputs.three("specularColor", _LARGEST_F0)
    most = max(color)
    if most == 0:
        return {"metallic": 0.0, "specular": 0.0}
    root = math.sqrt(most)
    tint = [each / most for each in color]
    return {"metallic": 0.0, "ior": (1 + root) / (1 - root), "specular_color": tint}
