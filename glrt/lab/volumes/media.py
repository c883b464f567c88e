"""Media: of any depth, turning light by any angle, of any colour, and met at any angle."""

from typing import Any

import numpy as np

from glrt.gpu.glsl import read
from glrt.lab.scenes import lamp, plane, quad, scene_of, sphere
from glrt.lab.sweep import SIGMAS, Lab, Sweep, mean_of
from glrt.rendering.pipelines import PLAIN, Variant
from glrt.scene.density import Density
from glrt.scene.scene import Scene

WEAKENED = "depth += hit.distance * medium_at(medium).extinction"
UNWEAKENED = "depth += 0.0 * medium_at(medium).extinction"
SIDE = 16  # of a picture, in pixels
ALBEDO = 0.5  # share of scattering in a medium
BOUNCES = 60  # what is left beyond them is ALBEDO to that power
EVEN = {"bottom": [1.0] * 3, "top": [1.0] * 3}
EDGE = 16  # voxels of a grid along an edge
_GRID, _TRANSFER = "media/grid.glsl", "media/transfer.glsl"
_FLIGHT, _PATH = "media/flight.glsl", "integrators/path_in_media.glsl"
_START, _AROUND = "integrators/path_state.glsl", "HAS_MEDIA ? frame.camera_medium : NO_MEDIUM"


def equilibrium(depth: float, g: float = 0.0, density: Density | None = None) -> Scene:
    """A ball of gas and a lamp in it that emit what they absorb, under an even sky: all is 1.

    `depth` is the optical depth of the radius where the density is 1, and `g` the anisotropy.
    """
    half = [ALBEDO * depth] * 3
    gas: dict[str, Any] = {"scattering": half, "absorption": half, "emission": half}
    gas |= {"anisotropy": g, **({"density": density} if density else {})}
    body = {**sphere([0, 0, -3], 1, "none"), "medium": "gas"}
    return scene_of(
        [body, sphere([0.2, 0, -3], 0.4, "lamp")],
        {"lamp": lamp(0.5, 0.5)},
        {"fov": 30},
        media={"gas": gas},
        background=EVEN,
    )


def depth(lab: Lab) -> Sweep:
    """Error of gas in equilibrium, from almost nothing to a thousand mean free paths."""
    x = np.logspace(-3, 3, 13).tolist()
    text = {_FLIGHT: read(_FLIGHT).replace(WEAKENED, UNWEAKENED)}
    naive = {"lamps that shine as through vacuum": Variant(texts=text)}
    return _even("optical depth of the radius", x, lab, [equilibrium(it) for it in x], naive)


def turn(lab: Lab) -> Sweep:
    """Error of gas in equilibrium that scatters back, evenly or forward."""
    x = [-0.99, -0.9, -0.5, 0.0, 0.5, 0.9, 0.99]
    even = read(_PATH).replace("eval_phase(medium.anisotropy,", "eval_phase(0.0,")
    naive = {"lamps that are scattered evenly": Variant(texts={_PATH: even})}
    return _even("anisotropy", x, lab, [equilibrium(2.0, g) for g in x], naive)


def spike(lab: Lab) -> Sweep:
    """Error of gas in equilibrium with one voxel that is denser than all others."""
    x = [1.0, 10.0, 100.0, 1000.0, 10000.0]
    scenes = [equilibrium(1.0, density=_with_spike(ratio)) for ratio in x]
    bound = "voxel_at(first + number).x"
    text = {_GRID: read(_GRID).replace(bound, f"min(1.0 / grid.top, {bound})")}
    naive = {"bounds that leave the voxel out": Variant(texts=text)}
    return _even("density of a voxel over that of the others", x, lab, scenes, naive)


def layer(lab: Lab) -> Sweep:
    """Error of the light behind a layer that a transfer function makes thin, of depth 1."""
    x = np.logspace(0, -2, 5)
    inner = "opacity = max(opacity, knot.opacity)"
    text = {_TRANSFER: read(_TRANSFER).replace(inner, "opacity = max(opacity, 0.0)")}
    found: dict[str, list[float]] = {}
    samples = lab.count(256, 64)
    size: dict[str, Any] = {"width": SIDE, "height": SIDE, "bounces": 0}
    for way, variant in {"glrt": PLAIN, "bounds without knots": Variant(texts=text)}.items():
        pictures = [lab.render(_layered(float(it)), samples, variant, **size) for it in x]
        figures = map(mean_of, pictures)
        # All channels see the same collisions: a mean has the error of one.
        found[way] = [abs(m - np.exp(-1)) / max(e * 3**0.5, 1e-7) for m, e in figures]
    chosen, other = found.items()
    return Sweep(
        parameter="densities in the layer over all densities",
        measure="difference from the truth, in standard errors",
        x=x.tolist(),
        chosen=chosen,
        others=dict([other]),
        promise=f"at most {SIGMAS} standard errors",
        bound=[SIGMAS] * len(x),
    )


def _layered(width: float) -> Scene:
    """Return a box whose density rises from 0 to 1 along the view, and takes light around 1/2.

    Opacity is a tent of `width` with the peak o. The mean of -ln(1 - o) under it is
    1 + (1 - o) ln(1 - o) / o. Half a voxel is even at both ends of the box, which is 2 deep.
    """
    peak, ends = 0.9, [0.5 - width / 2, 0.5, 0.5 + width / 2]
    mean = 1 + (1 - peak) * np.log1p(-peak) / peak
    deep = 2 * EDGE / (EDGE + 1) * width
    transfer = {"values": ends, "colors": [[0.0] * 3] * 3, "opacities": [0.0, peak, 0.0]}
    ramp = np.arange(EDGE + 1, dtype=np.float32)[:, None, None] / EDGE
    scan = {"density": Density(ramp), "transfer": {**transfer, "length": deep * mean}}
    body = {"shape": "box", "min": [-1, -1, -1], "max": [1, 1, 1], "material": "none"}
    return scene_of(
        [{**body, "medium": "scan"}],
        {},
        {"position": [0, 0, 5], "look_at": [0, 0, 0], "fov": 0.01},
        media={"scan": scan},
        background=EVEN,
    )


def _with_spike(ratio: float) -> Density:
    """Return a grid of density 1, but `ratio` in a voxel in front of the lamp."""
    values = np.ones((EDGE, EDGE, EDGE), np.float32)
    values[3 * EDGE // 4, EDGE // 2, EDGE // 2] = ratio
    return Density(values)


def _even(
    parameter: str, x: list[float], lab: Lab, scenes: list[Scene], naive: dict[str, Variant]
) -> Sweep:
    """Return how far pictures of radiance 1 are from it, by the method `mis` and a naive way."""
    samples = lab.count(256, 64)
    size: dict[str, Any] = {"width": SIDE, "height": SIDE, "bounces": BOUNCES}
    found: dict[str, list[float]] = {}
    for way, variant in {"glrt": PLAIN, **naive}.items():
        pictures = [lab.render(scene, samples, variant, **size) for scene in scenes]
        figures = map(mean_of, pictures)
        found[way] = [abs(mean - 1) / stderr for mean, stderr in figures]
    chosen, *others = found.items()
    return Sweep(
        parameter=parameter,
        measure="difference from the truth, in standard errors",
        x=x,
        chosen=chosen,
        others=dict(others),
        promise=f"at most {SIGMAS} standard errors",
        bound=[SIGMAS] * len(x),
    )


def colors(lab: Lab) -> Sweep:
    """Noise of fog that is denser for blue than for red, by how its paths fly."""
    x = [1.0, 2.0, 5.0, 10.0, 30.0, 100.0]
    alone = {
        "dot(flight.chances, flight.left)": "flight.left[flight.channel]",
        "dot(flight.chances, flight.left * medium.extinction)": "flight.left[flight.channel] "
        "* medium.extinction[flight.channel]",
    }
    text = read(_FLIGHT)
    for old, new in alone.items():
        text = text.replace(old, new)
    variants = {
        "glrt: the chances of all channels": PLAIN,
        "one channel alone": Variant(texts={_FLIGHT: text}),
    }
    samples = lab.count(256, 64)
    found = {
        name: [_noise(lab, ratio, samples, variant) for ratio in x]
        for name, variant in variants.items()
    }
    chosen, other = found.items()
    return Sweep(
        parameter="density for blue over that for red",
        measure="noise of a sample over the mean, in the noisiest channel",
        x=x,
        chosen=chosen,
        others=dict([other]),
        promise="at most 2",
        bound=[2.0] * len(x),
    )


def _noise(lab: Lab, ratio: float, samples: int, variant: Variant) -> float:
    fog = {"scattering": [0.3, 0.3 * ratio**0.5, 0.3 * ratio], "absorption": [0.02] * 3}
    body = {**sphere([0, 0, -3], 1, "none"), "medium": "fog"}
    scene = scene_of([body], {}, {"fov": 30}, media={"fog": fog}, background=EVEN)
    image = lab.render(scene, samples, variant, width=SIDE, height=SIDE, bounces=BOUNCES)
    noise = np.sqrt(np.square(image.stderr, dtype=np.float64).mean(axis=(0, 1)) * samples)
    return float((noise / image.radiance.mean(axis=(0, 1))).max())


def skim(lab: Lab) -> Sweep:
    """Error of the light that is left of a lamp behind a half space, by the angle to its plane."""
    x = np.logspace(-6, 0, 7)
    bodies: dict[str, dict[str, Any]] = {
        "the half space behind a plane": plane([0, 0, 0], [0, 1, 0], "none"),
        "a box": {"shape": "box", "min": [-9, -9, -9], "max": [9, 0, 9], "material": "none"},
    }
    found = {
        name: [_error_at(lab, body, float(angle)) for angle in x] for name, body in bodies.items()
    }
    chosen, other = found.items()
    return Sweep(
        parameter="angle to the plane, radians",
        measure="relative error of the light that is left",
        x=x.tolist(),
        chosen=chosen,
        others=dict([other]),
        promise="at most 1e-5",
        bound=[1e-5] * len(x),
    )


def sight_into_fog(body: dict[str, Any], angle: float) -> Scene:
    """Return a lamp in absorbing fog, seen from outside along a line at an angle to its surface.

    The line of sight is 1 long in front of the fog, and 1.5 inside.
    """
    away = np.array([np.cos(angle), -np.sin(angle), 0.0])
    eye = -away  # the line of sight meets the plane in the origin
    end, across = 1.5 * away, np.array([np.sin(angle), np.cos(angle), 0.0])
    corner = end - 9 * across - np.array([0, 0, 9.0])
    wall = quad(corner.tolist(), (18 * across).tolist(), [0, 0, 18.0], "lamp")
    return scene_of(
        [{**body, "medium": "fog"}, wall],
        {"lamp": lamp(1.0)},
        {"position": eye.tolist(), "look_at": [0, 0, 0], "fov": 1e-12},
        media={"fog": {"absorption": [1.0] * 3}},
    )


def _error_at(lab: Lab, body: dict[str, Any], angle: float) -> float:
    """Return the error for a camera that looks into the fog at an angle."""
    scene = sight_into_fog(body, angle)
    mean, _ = mean_of(lab.render(scene, 16, width=1, height=1, bounces=0))
    return float(abs(mean / np.exp(-1.5) - 1))


def inside(lab: Lab) -> Sweep:
    """Error of the light that a camera sees across a ball of fog, by its place in the ball."""
    x = np.logspace(-6, 0, 7)
    text = {_START: read(_START).replace(_AROUND, "NO_MEDIUM")}
    ways = {"glrt": (1, PLAIN), "a path begins in vacuum": (1, Variant(texts=text))}
    ways |= {"glrt, as far outside": (-1, PLAIN)}
    found = {
        name: [_error_across(lab, side * float(it), variant) for it in x]
        for name, (side, variant) in ways.items()
    }
    chosen, *others = found.items()
    return Sweep(
        parameter="depth of the camera in a ball of radius 1",
        measure="relative error of the light that is left",
        x=x.tolist(),
        chosen=chosen,
        others=dict(others),
        promise="at most 1e-5",
        bound=[1e-5] * len(x),
    )


def _error_across(lab: Lab, depth: float, variant: Variant) -> float:
    """Return the error for a camera so deep in the ball that it looks through; above 0: inside."""
    eye = {"position": [0, 0, 1 - depth], "look_at": [0, 0, -9], "fov": 1e-12}
    body = {**sphere([0, 0, 0], 1, "none"), "medium": "fog"}
    media = {"fog": {"absorption": [1.0] * 3}}
    scene = scene_of([body], {}, eye, media=media, background=EVEN)
    mean, _ = mean_of(lab.render(scene, 16, variant, width=1, height=1, bounces=0))
    return float(abs(mean / np.exp(max(depth, 0) - 2) - 1))
