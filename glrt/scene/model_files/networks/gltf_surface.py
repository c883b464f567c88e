"""The surface of glTF as a node of MaterialX, as a principled material."""

import math

from glrt.scene.model_files.networks.evaluation import times
from glrt.scene.model_files.networks.inputs import BRIGHTEST, Defaults, Inputs
from glrt.scene.model_files.networks.layered import film
from glrt.scene.model_files.networks.nodes import Table

DEFAULTS: Defaults = {
    "base_color": (1.0, 1.0, 1.0),
    "metallic": 1.0,
    "roughness": 1.0,
    "transmission": 0.0,
    "specular": 1.0,
    "specular_color": (1.0, 1.0, 1.0),
    "ior": 1.5,
    "alpha": 1.0,
    "alpha_mode": 0.0,
    "alpha_cutoff": 0.5,
    "iridescence": 0.0,
    "iridescence_ior": 1.3,
    "iridescence_thickness": 100.0,
    "sheen_color": (0.0, 0.0, 0.0),
    "sheen_roughness": 0.0,
    "clearcoat": 0.0,
    "clearcoat_roughness": 0.0,
    "emissive": (0.0, 0.0, 0.0),
    "emissive_strength": 1.0,
    "thickness": 0.0,
    "attenuation_distance": 0.0,
    "attenuation_color": (1.0, 1.0, 1.0),
    "anisotropy_strength": 0.0,
    "anisotropy_rotation": 0.0,
    "dispersion": 0.0,
}
_MASK = 1


def gltf_surface(inputs: Inputs) -> Table:
    """Return the table of a material."""
    inputs.report_vectors("clearcoat_normal", "tangent")
    table: Table = {"color": inputs.color_key(inputs.found("base_color"), "base_color")}
    for name in ("metallic", "roughness"):
        table[name] = inputs.number_key(inputs.found(name), name)
    table["specular"] = inputs.number("specular")
    table["specular_color"] = list(inputs.three("specular_color"))
    table["ior"] = inputs.number("ior", 1e3, 1.0)
    if inputs.has("clearcoat"):
        for name in ("clearcoat", "clearcoat_roughness"):
            table[name] = inputs.number(name)
    if inputs.has("sheen_color"):
        table["sheen"] = list(inputs.three("sheen_color"))
        table["sheen_roughness"] = inputs.number("sheen_roughness")
    table |= _glass(inputs)
    if strength := inputs.number("anisotropy_strength"):
        if isinstance(table["roughness"], dict):
            inputs.left.add("anisotropy_strength with a texture of roughness")
        else:
            turn = inputs.number("anisotropy_rotation", 1e3, -1e3)
            table["anisotropy"] = strength
            table["anisotropy_rotation"] = math.degrees(math.remainder(turn, math.tau))
    if share := inputs.number("iridescence"):
        thickness = inputs.number("iridescence_thickness", 1e4)
        table |= film(thickness, inputs.number("iridescence_ior", 10.0, 1.0), share)
    strength = inputs.number("emissive_strength", BRIGHTEST)
    emitted = times(inputs.found("emissive"), (strength,))
    emission = inputs.color_key(emitted, "emissive", BRIGHTEST)
    if isinstance(emission, dict) or any(emission):
        table["emission"] = emission
    if mode := inputs.number("alpha_mode", 2):
        table["alpha"] = inputs.number_key(inputs.found("alpha"), "alpha")
        if mode == _MASK:
            table["alpha_cutoff"] = inputs.number("alpha_cutoff")
    if normal := inputs.normal_key("normal"):
        table["normal"] = normal
    return table


def _glass(inputs: Inputs) -> Table:
    if not inputs.has("transmission"):
        return {}
    found = inputs.number_key(inputs.found("transmission"), "transmission")
    is_thin = inputs.number("thickness", 1e15) == 0
    table: Table = {"transmission": found, "thin": is_thin}
    if (distance := inputs.number("attenuation_distance", 1e15)) > 0 and not is_thin:
        table["attenuation_distance"] = distance
        table["attenuation_color"] = list(inputs.three("attenuation_color"))
    if spread := inputs.number("dispersion", 10.0):
        table["dispersion"] = spread
    return table
