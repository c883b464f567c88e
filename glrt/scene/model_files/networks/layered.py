"""Parts that Standard Surface and OpenPBR have in common, as keys of a principled material."""

import math
from collections.abc import Callable

from glrt.scene.model_files.networks.arithmetic import between
from glrt.scene.model_files.networks.evaluation import Found, Picture, VertexColors, times
from glrt.scene.model_files.networks.inputs import BRIGHTEST, Inputs, short
from glrt.scene.model_files.networks.nodes import Numbers, Table

Alphas = Callable[[float, float], tuple[float, float]]

_THINNEST = 1e-6  # length after which glass has its color; thinner is none


def weighted(inputs: Inputs, weight: str, color: str) -> Found:
    """Return a color or its texture, multiplied by a number or its texture."""
    share, found = inputs.found(weight), inputs.found(color)
    if isinstance(share, tuple):
        return times(found, share[:1])
    inputs.left.add(f"textures of {weight}")
    return found


def base_color(inputs: Inputs, base: Found, under: str, under_color: str) -> Found:
    """Return the color of a base; a share scatters light inside, and shows its own color.

    `under` is the input of that share, and `under_color` that of its color.
    """
    if not inputs.has(under):
        return base
    inputs.left.add(f"scattering below the surface ({under})")
    share, inner = inputs.found(under), inputs.found(under_color)
    return mixed(inputs, base, inner, share, under_color)


def mixed(inputs: Inputs, base: Found, other: Found, share: Found, name: str) -> Found:
    """Return the mean of two colors by a share; textures are reported unless one is all of it."""
    if isinstance(share, tuple) and share[0] >= 1.0:
        return other
    if isinstance(share, tuple) and isinstance(base, tuple) and isinstance(other, tuple):
        return between(base, other, share[0])
    if base != other:
        inputs.left.add(f"{name}, mixed with textures")
    return base


def facets(inputs: Inputs, roughness: str, anisotropy: str, alphas: Alphas) -> Table:
    """Return roughness and anisotropy that give the same alphas of GGX along and across.

    `alphas` gives both for a roughness and an anisotropy, as the surface defines them.
    """
    rough = inputs.number_key(inputs.found(roughness), roughness)
    share = inputs.number(anisotropy)
    if not share:
        return {"roughness": rough}
    if isinstance(rough, dict):
        inputs.left.add(f"{anisotropy} with a texture of {roughness}")
        return {"roughness": rough}
    along, across = alphas(rough, share)
    if across >= 1:
        return {"roughness": 1.0}
    grain = math.sqrt(max(min(along, 1.0) - across, 0.0) / (1 - across))
    return {"roughness": short(math.sqrt(across)), "anisotropy": short(grain)}


def glass(inputs: Inputs, names: dict[str, str], base: Found, is_thin: bool) -> Table:
    """Return the keys of glass, with the color of the surface, whose base has another color.

    `names` has the inputs `weight`, `color`, `depth` and `scatter` of light that crosses.
    """
    weight = inputs.found(names["weight"])
    if weight == (0.0,):
        return {"color": inputs.color_key(base, "base_color")}
    table: Table = {"transmission": inputs.number_key(weight, names["weight"]), "thin": is_thin}
    depth = inputs.number(names["depth"], 1e15)
    crossing = inputs.found(names["color"])
    if depth > _THINNEST and not is_thin:
        table["attenuation_color"] = list(inputs.three(names["color"]))
        table["attenuation_distance"] = depth
        crossing = (1.0, 1.0, 1.0)
    inputs.report(names["scatter"])
    color = mixed(inputs, base, crossing, weight, names["color"])
    table["color"] = inputs.color_key(color, names["color"])
    return table


def coated(inputs: Inputs, weight: str, color: str, under: Found) -> Found:
    """Return the color of what lies under a coat that tints it."""
    if not inputs.has(weight) or not inputs.has(color):
        return under
    share, tint = inputs.found(weight), inputs.found(color)
    inputs.left.add(f"{color} on facets, as it tints the base alone")
    if isinstance(tint, Picture | VertexColors) or not isinstance(share, tuple):
        if share == (1.0,) and isinstance(under, tuple):
            return times(tint, under)
        inputs.left.add(f"textures of {color}")
        return under
    kept: Numbers = tuple(1 + (each - 1) * share[0] for each in tint or ())
    return times(under, kept)


def film(thickness: float, ior: float, weight: float) -> Table:
    """Return the keys of a thin film; the thickness is in nanometres."""
    if not weight or not thickness:
        return {}
    return {"iridescence": weight, "iridescence_ior": ior, "iridescence_thickness": thickness}


def fibres(inputs: Inputs, weight: str, color: str, roughness: str) -> Table:
    """Return the keys of sheen."""
    if not inputs.has(weight):
        return {}
    tint = weighted(inputs, weight, color)
    if not isinstance(tint, tuple):
        inputs.left.add(f"textures of {color}")
        tint = (1.0,)
    wide = tint if len(tint) > 2 else tint * 3
    sheen = list(inputs.within(wide, color))
    return {"sheen": sheen, "sheen_roughness": inputs.number(roughness)} if any(sheen) else {}


def emission(inputs: Inputs, weight: str, color: str) -> Table:
    """Return the key of emission, if there is any."""
    if not inputs.has(weight):
        return {}
    found = inputs.color_key(weighted(inputs, weight, color), color, BRIGHTEST)
    return {"emission": found} if isinstance(found, dict) or any(found) else {}


def opacity(inputs: Inputs, name: str) -> Table:
    """Return the key of alpha; colors count by their mean."""
    found = inputs.found(name)
    if isinstance(found, tuple) and len(found) > 2:
        found = (sum(found[:3]) / 3,)
    alpha = inputs.number_key(found, name)
    return {} if alpha == 1.0 else {"alpha": alpha}
