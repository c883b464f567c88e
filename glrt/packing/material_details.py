"""Tables of material data that does not fit into the struct Material.

shaders_glsl/structs/details.glsl declares the rows.
"""

import hashlib
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from glrt.packing.kernel_structs import CONSTANTS, STRUCTS
from glrt.packing.tree_cache import kept
from glrt.plan.facts import SceneFacts
from glrt.scene.materials import facets, gloss
from glrt.scene.materials.conductors import Conductor
from glrt.scene.materials.dielectric import Dielectric
from glrt.scene.materials.facets import STEPS, FacetLoss, facet_loss, mean_loss, pane_loss
from glrt.scene.materials.gloss import (
    ROUGHNESS_STEPS,
    FacetShares,
    facet_shares,
    shares_around,
    shares_by_step,
    turn_weights,
)
from glrt.scene.materials.metal import Metal
from glrt.scene.materials.principled import Principled
from glrt.scene.materials.sheen import sheen_albedos, sheen_alpha
from glrt.scene.materials.thin_film import ThinFilm, reflectance_bound

Array = np.ndarray[Any, Any]
ALBEDOS = STEPS  # rows of the struct Albedo for each kind of facets


def conductor_rows(facts: SceneFacts) -> dict[str, int]:
    """Return the rows of materials in the array of the struct Conductor, by name."""
    return {metal: row for row, metal in enumerate(_metals(facts))}


def _metals(facts: SceneFacts) -> dict[str, Conductor]:
    return {
        name: metal.conductor
        for name, metal in facts.materials.items()
        if isinstance(metal, Metal) and metal.conductor
    }


def pack_conductors(facts: SceneFacts) -> Array:
    """Return rows of the struct Conductor."""
    metals = _metals(facts)
    rows = np.zeros(len(metals), STRUCTS["Conductor"])
    if metals:
        rows["n"], rows["k"] = zip(*metals.values(), strict=True)
    return rows


def glass_rows(facts: SceneFacts) -> dict[str, int]:
    """Return the rows of materials in the array of the struct Glass, by name."""
    return {glass: row for row, glass in enumerate(facts.glasses)}


def pack_facets(facts: SceneFacts) -> dict[str, Array]:
    """Return rows of the structs Glass, Gloss and Albedo, by name."""
    albedos: Albedos = []
    glasses = _pack_glasses(facts, albedos)
    gloss = _pack_gloss(facts, albedos)
    tables = _rows_of(albedos)
    return {"Glass": glasses, "Gloss": gloss, "Albedo": np.concatenate([tables, *_layers(facts)])}


Albedos = list[tuple[Array, Array]]  # two albedos at each step
Finished = tuple[str, Principled, FacetShares]  # a material with its name and one row's shares


def _pack_glasses(facts: SceneFacts, albedos: Albedos) -> Array:
    """Return rows of the struct Glass, and append the albedos of their facets to `albedos`."""
    glasses = list(facts.glasses.values())
    nested = glasses[: len(facts.nested)]
    around = [(glass, 1.0) for glass in glasses]  # each with the index of what lies around it
    first_pairs = []
    for place, glass in enumerate(glasses):
        first_pairs.append(len(around))
        if glass.alpha:
            around += [(glass, other.ior) for other in nested[place + 1 :]]
    rows = np.zeros(len(around), STRUCTS["Glass"])
    for row, glass, first in zip(rows, glasses, first_pairs, strict=False):
        row["absorption"], row["ior"], row["first_pair"] = glass.absorption, glass.ior, first
    for row, (glass, index) in zip(rows, around, strict=True):
        row["first_albedo"] = CONSTANTS["NO_DETAILS"]
        if loss := _loss(glass, index):
            row["first_albedo"] = ALBEDOS * len(albedos)
            row["mean_outer"], row["mean_inner"] = loss.means
            row["crossing_outer"], row["crossing_inner"] = loss.crossing
            albedos.append(loss.albedos)
    return rows


def _loss(glass: Dielectric, around: float) -> FacetLoss | None:
    """Return the losses of facets between glass and a material with the index `around`."""
    if not glass.alpha:
        return None
    return (pane_loss if glass.thin else facet_loss)(glass.alpha, glass.ior / around)


def gloss_rows(facts: SceneFacts) -> dict[str, int]:
    """Return the first row of each material in the array of the struct Gloss, by name."""
    found, first = dict[str, int](), 0
    for name, material in _principled(facts).items():
        found[name] = first
        first += 1 if material.roughness_map is None else ROUGHNESS_STEPS + 1
    return found


def _facets(material: Principled) -> list[FacetShares]:
    """Return the facet shares of each row: one, or one for each step of a textured roughness.

    Facets that are rougher in one direction have those of their means over all directions.
    """
    if material.roughness_map is None:
        return [facet_shares(material.facet_alpha, material.stretch)]
    return _by_step()


def _tables(material: Principled, shares: FacetShares) -> list[FacetShares]:
    """Return the facet shares whose tables the kernel reads, one after the other."""
    if material.anisotropy > 0:
        return list(shares_around(material.facet_alpha, material.stretch))
    return [shares]


@cache
def _by_step() -> list[FacetShares]:
    """Return the facet shares at each step of roughness; they take 2 s and are kept on disk."""
    texts = [Path(module.__file__ or "").read_bytes() for module in (facets, gloss)]
    known_as = f"gloss-{hashlib.blake2b(b''.join(texts), digest_size=16).hexdigest()}"
    rows = kept(known_as, shares_by_step)
    return [FacetShares.of(*row) for row in zip(rows["head_on"], rows["grazing"], strict=True)]


def glass_parts(facts: SceneFacts) -> dict[str, Dielectric]:
    """Return the glass of principled materials that are partly glass, by name.

    Its rows of the struct Material follow the rows of the finishes.
    """
    materials = _principled(facts).items()
    return {name: material.glass for name, material in materials if material.glass}


def _principled(facts: SceneFacts) -> dict[str, Principled]:
    return {name: it for name, it in facts.materials.items() if isinstance(it, Principled)}


def _pack_gloss(facts: SceneFacts, albedos: Albedos) -> Array:
    """Return rows of the struct Gloss, and append the albedos of their facets to `albedos`."""
    found = _principled(facts)
    of_all = [(name, it, shares) for name, it in found.items() for shares in _facets(it)]
    rows = np.zeros(len(of_all), STRUCTS["Gloss"])
    first: dict[int, int] = {}  # row of the albedos, by the identity of shares

    def place(*tables: FacetShares) -> int:
        known_as = id(tables[0])
        if known_as not in first:
            first[known_as] = ALBEDOS * len(albedos)
            albedos.extend((shares.head_on, shares.grazing) for shares in tables)
        return first[known_as]

    parts = {part: len(facts.finishes) + k for k, part in enumerate(glass_parts(facts))}
    for row, (name, it, shares) in zip(rows, of_all, strict=True):
        row["f0"], row["f90"] = it.head_on, it.specular
        row["transmission"], row["glass"] = it.glass_share, parts.get(name, 0)
        row["coat"], row["coat_alpha"] = it.clearcoat, it.coat_alpha
        tables = _tables(it, shares)
        row["first"] = row["first_coat"] = place(*tables)
        row["turns"] = len(tables) - 1
        if it.clearcoat:
            row["first_coat"] = place(facet_shares(it.coat_alpha))
        row["kept"], row["brightest"] = shares.kept, max(it.head_on)
        row["spread"] = 1 / (1 - shares.kept) if shares.kept < 1 else 0.0
        row["again"] = again = _again(max(it.head_on), it.specular, shares.kept)
        left = 1 - _taken(max(it.head_on), it.specular, again, shares)
        row["even_base"] = 1 / left if left > 0 else 0.0
    _put_layers(facts, of_all, rows, ALBEDOS * len(albedos))
    return rows


def _put_layers(facts: SceneFacts, of_all: list[Finished], rows: Array, first: int) -> None:
    """Change rows of the struct Gloss with layers of their own, whose rows begin at `first`."""
    row_of = dict[str, int]()
    for name, own in zip(_layered(facts), _layers(facts), strict=True):
        row_of[name] = first
        first += len(own)
    for row, (name, it, shares) in zip(rows, of_all, strict=True):
        if name in row_of:
            row["glass"] = -1 - row_of[name]
            row["brightest"], _ = factors = _bound(it)
            tables = _tables(it, shares)
            weights = turn_weights(it.stretch) if len(tables) > 1 else np.ones(1)
            left = _mean_left(tables, weights, (*factors, float(row["again"])))
            row["even_base"] = 1 / left if left > 0 else 0.0


def _bound(material: Principled) -> tuple[float, float]:
    """Return f0 and f90 that bound the reflectance of facets that are partly under a film."""
    film, specular = material.film, material.specular
    if film is None or specular == 0:
        return max(material.head_on), specular
    share = material.iridescence * film.presence
    red, green, blue = (each / specular for each in material.head_on)
    head, edge = reflectance_bound(film, (red, green, blue))
    f0 = max(material.head_on) + share * (specular * head - max(material.head_on))
    return f0, specular + share * specular * (edge - 1)


def _mean_left(tables: list[FacetShares], weights: Array, factors: tuple[float, ...]) -> float:
    """Return the share of even light that facets under a film leave.

    `factors` are those of the light by `head_on`, by `grazing` and lost. At grazing angles they
    bound what is taken by more than all light.
    """
    taken = [
        np.array(factors) @ [it.head_on, it.grazing, 1 - it.head_on - it.grazing] for it in tables
    ]
    return float(weights @ [mean_loss(np.minimum(each, 1)) for each in taken])


def _layered(facts: SceneFacts) -> dict[str, Principled]:
    found = _principled(facts)
    return {
        name: it
        for name, it in found.items()
        if it.film or any(it.sheen) or it.diffuse_transmission
    }


def _layers(facts: SceneFacts) -> list[Array]:
    """Return rows of the struct Albedo for each material with layers of its own.

    The first is the thin film, the second the sheen. Albedos of sheen follow, then what the matte
    base lets through.
    """
    return [_layer(it) for it in _layered(facts).values()]


def _layer(material: Principled) -> Array:
    rows = np.zeros(2, STRUCTS["Albedo"])
    film = material.film or ThinFilm(1.0, 0.0)
    share = material.iridescence * film.presence
    rows[0] = share, film.ior, film.micrometres, _bound(material)[1]
    alpha = sheen_alpha(material.sheen_roughness)
    rows[1] = *material.sheen, 0.5 / alpha
    none = (np.zeros(ALBEDOS + 1),) * 2
    albedos = _rows_of([sheen_albedos(alpha) if any(material.sheen) else none])
    base = np.zeros(1, STRUCTS["Albedo"])
    through = material.diffuse_transmission
    base[0] = *(through * color for color in material.diffuse_transmission_color), through
    return np.concatenate([rows, albedos, base])


def _again(f0: float, f90: float, kept: float) -> float:
    """Return the share of light that returns after several facets: F^2 E / (1 - F (1 - E)).

    F is the mean reflectance, and E the share of even light that white facets keep. Kulla and
    Conty, "Revisiting Physically Based Shading at Imageworks" (2017).
    """
    mean = f0 + (f90 - f0) / 21
    return mean**2 * kept / (1 - mean * (1 - kept))


def _taken(f0: float, f90: float, again: float, shares: FacetShares) -> float:
    """Return the share of even light that dielectric facets reflect."""
    lost = 1 - shares.mean_head_on - shares.mean_grazing
    return f0 * shares.mean_head_on + f90 * shares.mean_grazing + again * lost


def _rows_of(albedos: Albedos) -> Array:
    rows = np.zeros((len(albedos), ALBEDOS), STRUCTS["Albedo"])
    for part, both in zip(rows, albedos, strict=True):
        for name, albedo in zip(("one", "other"), both, strict=True):
            part[name], part[f"{name}_end"] = albedo[:-1], albedo[1:]
    return rows.reshape(-1)
