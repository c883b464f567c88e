"""Rough glass, plastic, films, cloth, paper, brushed metal: the light that they keep."""

import math
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from glrt.lab.scenes import Table, glass, lamp, matte, scene_of, sphere
from glrt.lab.sweep import SIGMAS, Array, Lab, Sweep, mean_of
from glrt.rendering.shader_functions import World
from glrt.scene.scene import Scene

ROUGHNESS = 0.3
_SAMPLE = """
    mat3 up = frame_around(vec3(0.0, 0.0, 1.0));
    Vertex vertex = vertex_of(up, wo, material_at(0), true);
    Scattering next = sample_principled(vertex, u.x, u.yz);
    float kept = next.weight.x;"""
# The sample implementation of glTF 2.0, appendix B: what is below gets 1 - F at the half vector.
_GLTF = f"""{_SAMPLE}
    vec3 wi = next.direction;
    vec3 h = normalized(wo + wi);
    float reflected = 0.04 + 0.96 * schlick_weight(dot(wo, h));
    float alpha = vertex.material.alpha;
    float facets = reflected * pdf_ggx(alpha, wo, h) * ggx_weight(alpha, wo, wi);
    float value = facets + (1.0 - reflected) * pdf_matte(wi);
    kept = next.pdf > 0.0 ? value / next.pdf : 0.0;"""


def grazing(lab: Lab) -> Sweep:
    """Share of light that white plastic loses or gains."""
    x = [1.0, 0.7, 0.5, 0.3, 0.2, 0.1, 0.05, 0.03, 0.01, 0.003, 0.001]
    count = lab.count(1 << 16, 1 << 15)
    plastic: dict[str, Any] = {"type": "principled", "roughness": ROUGHNESS}
    scene = scene_of([sphere([0, 0, -3], 1, "p")], {"p": plastic})
    ways = {"glrt: the base gets what facets leave": _SAMPLE, "glTF, appendix B": _GLTF}
    errors: dict[str, list[float]] = {name: [] for name in ways}
    for cosine in x:
        wo = np.tile([np.sqrt(1 - cosine**2), 0, cosine], (count, 1))
        for name, setup in ways.items():
            kept = lab.path("kept", {"u": lattice(count), "wo": wo}, World(scene), setup=setup)
            errors[name].append(abs(float(kept.astype(np.float64).mean()) - 1))
    first, *others = errors.items()
    return Sweep(
        parameter="cosine of the angle to the normal",
        measure="light lost or gained\n(share)",
        x=x,
        chosen=first,
        others=dict(others),
        promise="at most 0.01",
        bound=[0.01] * len(x),
    )


_BRUSHED = """
    mat3 up = frame_around(vec3(0.0, 0.0, 1.0));
    Vertex even = vertex_of(up, wo, material_at(0), true);
    Vertex vertex = vertex_along(even, up[0], material_at(0).ior);
    Scattering next = sample_principled(vertex, u.x, u.yz);
    float kept = next.weight.x;"""
_ONE_FACET = f"""{_BRUSHED}
    vec3 h = sample_facets(vertex, u.yz);
    vec3 wi = 2.0 * dot(wo, h) * h - wo;
    kept = wi.z > 0.0 ? facets_weight(vertex, wi) : 0.0;"""


def brushed(lab: Lab) -> Sweep:
    """Share of light that white brushed metal loses or gains: the worst of 24 directions."""
    x = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0]
    count = lab.count(1 << 15, 1 << 14)
    ways = {
        "glrt: what facets lose comes back": _BRUSHED,
        "facets that scatter once": _ONE_FACET,
    }
    errors: dict[str, list[float]] = {name: [] for name in ways}
    for anisotropy in x:
        metal = {"type": "principled", "metallic": 1.0, "roughness": ROUGHNESS}
        materials = {"m": {**metal, "anisotropy": anisotropy}}
        scene = scene_of([sphere([0, 0, -3], 1, "m")], materials)
        for name, way in ways.items():
            errors[name].append(max(_brushed_errors(lab, scene, way, count)))
    first, *others = errors.items()
    return Sweep(
        parameter="anisotropy",
        measure="light lost or gained\n(share, largest)",
        x=x,
        chosen=first,
        others=dict(others),
        promise="at most 0.01",
        bound=[0.01] * len(x),
    )


def _brushed_errors(lab: Lab, scene: Scene, setup: str, count: int) -> Iterator[float]:
    points = lattice(count)
    for cosine in (1.0, 0.7, 0.4, 0.1):
        for angle in (0.0, 0.4, 0.8, 1.2, 1.5, math.pi / 2):
            sine = math.sqrt(1 - cosine**2)
            wo = np.tile([sine * math.cos(angle), sine * math.sin(angle), cosine], (count, 1))
            kept = lab.path("kept", {"u": points, "wo": wo}, World(scene), setup=setup)
            yield abs(float(kept.astype(np.float64).mean()) - 1)


# The sample viewer of glTF: below a film comes 1 - F of the brightest channel at the half vector.
_VIEWER = f"""{_SAMPLE}
    vec3 wi = next.direction;
    vec3 h = normalized(wo + wi);
    vec3 reflected = film_reflectance(film_of(gloss_at(0)), vec3(0.04), dot(wo, h));
    float alpha = vertex.material.alpha;
    vec3 value = reflected * (pdf_ggx(alpha, wo, h) * ggx_weight(alpha, wo, wi));
    value += (1.0 - max(reflected.x, max(reflected.y, reflected.z))) * pdf_matte(wi);
    vec3 colors = next.pdf > 0.0 ? value / next.pdf : vec3(0.0);"""
_COLORS = f"{_SAMPLE}\n    vec3 colors = next.weight;"


def soap(lab: Lab) -> Sweep:
    """Share of light that white plastic under a film gains: the worst channel of six directions."""
    x = [50.0, 100.0, 150.0, 200.0, 300.0, 400.0, 600.0, 800.0, 1200.0]
    film = {"iridescence": 1.0, "iridescence_ior": 1.4}
    looks = [{"roughness": ROUGHNESS, **film, "iridescence_thickness": it} for it in x]
    ways = {"glrt: the base gets what a bound leaves": _COLORS, "sample viewer of glTF": _VIEWER}
    return _gained(lab, "thickness of the film (nm)", dict(zip(x, looks, strict=True)), ways, 0.005)


# Sheen that is not held back where it reflects more than all light.
_FREE = f"""{_COLORS}
    vec3 wi = next.direction;
    Sheen sheen = sheen_of(gloss_at(0));
    float most = max(albedos(sheen.first, wo.z).x, albedos(sheen.first, wi.z).x);
    float more = eval_white_sheen(sheen, wo, wi, normalized(wo + wi)) * (max(most, 1.0) - 1.0);
    if (next.pdf > 0.0) colors += more / next.pdf;"""


def velvet(lab: Lab) -> Sweep:
    """Share of light that white cloth gains: the worst of six directions."""
    x = [0.1, 0.15, 0.2, 0.25, 0.3, 0.35, 0.4]
    looks = {it: {"roughness": 0.8, "sheen": [1, 1, 1], "sheen_roughness": it} for it in x}
    ways = {"glrt: held back by its albedo": _COLORS, "sheen as it is": _FREE}
    return _gained(lab, "roughness of sheen", looks, ways, 0.01)


# A base that reflects all of its light, in addition to what it lets through.
_UNSHARED = f"""{_COLORS}
    vec3 wi = next.direction;
    Principled it = principled_of(vertex.material);
    float share = translucency_of(it.gloss).share;
    Shares from = shares_of(vertex, it.gloss, wi);
    Shares to = shares_of(vertex, it.gloss, vertex.wo);
    vec3 base = it.base * (from.base * to.base * it.gloss.even_base * wi.z / PI);
    if (next.pdf > 0.0 && !next.crosses) colors += share / (1.0 - share) * base / next.pdf;"""


def leaf(lab: Lab) -> Sweep:
    """Share of light that white paper gains, on both sides: the worst of six directions."""
    looks = {it: {"diffuse_transmission": it} for it in (0.1, 0.2, 0.3, 0.5, 0.7, 0.9)}
    ways = {"glrt: taken from the base": _COLORS, "added to the base": _UNSHARED}
    return _gained(lab, "share of the base that lets light through", looks, ways, 0.01)


def _gained(
    lab: Lab, parameter: str, looks: Mapping[float, Table], ways: Mapping[str, str], most: float
) -> Sweep:
    """The light that white principled surfaces gain, by a parameter; the first way is glrt's."""
    count = lab.count(1 << 16, 1 << 15)
    gains: dict[str, list[float]] = {name: [] for name in ways}
    for look in looks.values():
        materials = {"p": {"type": "principled", **look}}
        scene = scene_of([sphere([0, 0, -3], 1, "p")], materials)
        for name, setup in ways.items():
            gains[name].append(max(_gains(lab, scene, setup, count)))
    first, *others = gains.items()
    return Sweep(
        parameter=parameter,
        measure="light gained\n(share, largest)",
        x=list(looks),
        chosen=first,
        others=dict(others),
        promise=f"at most {most:g}",
        bound=[most] * len(looks),
    )


def _gains(lab: Lab, scene: Scene, setup: str, count: int) -> Iterator[float]:
    for cosine in (1.0, 0.7, 0.4, 0.1, 0.03, 0.01):
        wo = np.tile([math.sqrt(1 - cosine**2), 0, cosine], (count, 1))
        given = {"u": lattice(count), "wo": wo}
        colors = lab.path("colors", given, World(scene), setup=setup, returns="vec3")
        yield max(0.0, float(colors.astype(np.float64).mean(axis=0).max()) - 1)


INDEX = 1.5
_VERTEX = """
    mat3 up = frame_around(vec3(0.0, 0.0, 1.0));
    Vertex vertex = vertex_of(up, wo, material_at(0), outside == 1);
"""
_ONCE = """
    vec3 h = sample_ggx_normal(vertex.material.alpha, vertex.wo, u.yz);
    vec3 wi = beyond_facet(vertex, h, u.x);
    float weight = ggx_weight(vertex.material.alpha, vertex.wo, vec3(wi.xy, abs(wi.z)));
    float kept = wi.z == 0.0 ? 0.0 : weight;"""
# The lobes of lost light hold all that the table of albedos says is lost, by their normalisation.
_ALL = f"""{_ONCE}
    Glass glass = glass_at(vertex.material.details);
    if (has_lost_light(glass)) kept += 1.0 - facet_albedo(glass, outside == 1, wo.z);"""


def furnace(lab: Lab) -> Sweep:
    """Share of light that rough glass loses or gains: the worst of twelve directions."""
    return _furnace(lab, is_thin=False)


def panes(lab: Lab) -> Sweep:
    """Share of light that a rough pane loses or gains: the worst of twelve directions."""
    return _furnace(lab, is_thin=True)


def _furnace(lab: Lab, is_thin: bool) -> Sweep:
    x = [1e-3, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0]
    count = lab.count(1 << 16, 1 << 15)
    ways = {"glrt: what facets lose comes back": _ALL, "facets that scatter once": _ONCE}
    errors: dict[str, list[float]] = {name: [] for name in ways}
    for roughness in x:
        materials = {"glass": {**glass(INDEX), "roughness": roughness, "thin": is_thin}}
        scene = scene_of([sphere([0, 0, -3], 1, "glass")], materials)
        for name, way in ways.items():
            errors[name].append(_error(lab, scene, _VERTEX + way, count))
    first, *others = errors.items()
    return Sweep(
        parameter="roughness",
        measure="light lost or gained at one surface\n(share, largest)",
        x=x,
        chosen=first,
        others=dict(others),
        promise="at most 0.01",
        bound=[0.01] * len(x),
    )


def _error(lab: Lab, scene: Scene, setup: str, count: int) -> float:
    worst = 0.0
    points = lattice(count)
    for outside in (1, 0):
        for cosine in (1.0, 0.8, 0.5, 0.3, 0.1, 0.03):
            wo = np.tile([math.sqrt(1 - cosine**2), 0, cosine], (count, 1))
            given = {"u": points, "wo": wo, "outside": np.array([outside])}
            kept = lab.path("kept", given, World(scene), setup=setup)
            worst = max(worst, abs(float(kept.astype(np.float64).mean()) - 1))
    return worst


def lattice(count: int) -> Array:
    """Points of the unit cube that are spread evenly, (n, 3): Kronecker's sequence."""
    root = 1.2207440846057596  # of x^4 = x + 1
    steps = np.arange(count)[:, None] * root ** -np.arange(1.0, 4.0)
    points: Array = (steps + 0.5) % 1
    return points


def frosted(lab: Lab) -> Sweep:
    """Noise of a lamp inside a ball of frosted glass in a room."""
    x = [0.1, 0.2, 0.3, 0.4, 0.6, 0.8, 1.0]
    samples = lab.count(1024, 256)
    side = 32
    noise: dict[str, list[float]] = {"mis": [], "naive": [], "nee": []}
    wrong = []
    for roughness in x:
        scene = _lamp_in_glass(roughness)
        size: dict[str, Any] = {"width": side, "height": side, "bounces": 3}
        means = {m: mean_of(lab.render(scene, samples, method=m, **size)) for m in noise}
        for method, (mean, stderr) in means.items():
            noise[method].append(stderr * math.sqrt(samples) * side / mean)
        (mean, stderr), (other, spread) = means["mis"], means["naive"]
        if not abs(mean - other) <= SIGMAS * math.hypot(stderr, spread):
            wrong.append(roughness)
    first, *others = noise.items()
    return Sweep(
        parameter="roughness of the glass",
        measure="relative noise of one sample",
        x=x,
        chosen=first,
        others=dict(others),
        promise="as bright by mis as by naive, within 5.3 standard errors; no bound for the noise",
        wrong=wrong,
    )


def _lamp_in_glass(roughness: float) -> Scene:
    shapes = [
        sphere([0, 0, 0], 1, "wall"),
        sphere([0, 0, 0], 0.3, "glass"),
        sphere([0, 0, 0], 0.1, "lamp"),
    ]
    frosted_glass = {**glass(INDEX), "roughness": roughness}
    materials = {"wall": matte(0.5), "lamp": lamp(1), "glass": frosted_glass}
    return scene_of(shapes, materials, {"position": [0, 0, 0.8], "look_at": [0, 0, 1], "fov": 60})
