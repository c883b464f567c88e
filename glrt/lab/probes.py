"""Probes: light through thin walls, what is finer than a cell, and rooms that hardly absorb."""

from typing import Any

import numpy as np

from glrt.lab.scenes import Table, lamp, matte, quad, scene_of, sphere
from glrt.lab.sweep import Array, Lab, Sweep, mean_of
from glrt.rendering.pipelines import PLAIN, Variant
from glrt.scene.scene import Scene

SETTINGS: dict[str, Any] = {"width": 16, "height": 16, "sampler": "sobol", "method": "ddgi"}
SAMPLES = 64
TRUE = 4096  # samples of each of two truths
CELL = 2 / 3  # edge of a cell of the rooms side by side
HALF = CELL / 2
WIDE = 0.4  # edge of a cell of the single room
THICKNESSES = (0.01, 0.1, 0.25, 0.5)  # of a wall, in cells
TIGHT = 0.25  # thickness from which on a wall holds
MOST_LEAKED = 0.002
WITHOUT = Variant({"WITHOUT_VISIBILITY": True})

SHIFTS = (0.01, 0.03, 0.1, 0.15, 0.25, 0.5)  # in cells

GAPS = (0.01, 0.1, 0.3, 1.0, 2.0)  # in cells
ROUGHNESSES = (0.05, 0.2, 0.5, 1.0)
RADII = (0.3, 0.1, 0.03, 0.01, 0.003, 0.001)
MOST_WRONG = 0.08
LAMP = lamp(20.0)
DIRECT = "direct light alone"

ALBEDOS = (0.5, 0.8, 0.9, 0.95, 0.98, 0.99)
WHITEST, MOST_LACKING = 0.95, 0.012
PLAIN_UPDATES = 32  # number of updates of one set of probes


def leak(lab: Lab) -> Sweep:
    """Light of a sealed dark room over that of the floor of the lit room next to it."""
    leaks = _leaks(lab, [house(thickness * CELL, 1) for thickness in THICKNESSES])
    return Sweep(
        parameter="thickness of the wall, in cells",
        measure="light behind a wall over that before it",
        x=THICKNESSES,
        chosen=("ddgi", leaks.pop("ddgi")),
        others=leaks,
        promise=f"at most {MOST_LEAKED:g} from a thickness of {TIGHT:g} cells on",
        bound=[MOST_LEAKED] * len(THICKNESSES),
        guaranteed=[thickness >= TIGHT for thickness in THICKNESSES],
    )


def in_wall(lab: Lab) -> Sweep:
    """Light that leaks through a wall, with probes near the wall or in it."""
    scenes = [house(TIGHT * CELL, 1, shift * CELL) for shift in SHIFTS]
    leaks = _leaks(lab, scenes)
    return Sweep(
        parameter="from a wall's middle to probes, in cells",
        measure="light behind a wall over that before it",
        x=SHIFTS,
        chosen=("ddgi", leaks.pop("ddgi")),
        others=leaks,
        promise=f"at most {MOST_LEAKED:g}, wherever probes stand",
        bound=[MOST_LEAKED] * len(SHIFTS),
    )


def contact(lab: Lab) -> Sweep:
    """Error of the light under a ball, by how high it hangs over the floor."""
    errors: dict[str, list[float]] = {"gather": [], "ddgi": []}
    for gap in GAPS:
        ball = sphere([0, gap * WIDE - 1 + 0.3, 0], 0.3, "m")
        scene = room(ball, {"position": [0, -0.7, 0.9], "look_at": [0, -1, 0], "fov": 35})
        _add_errors(lab, scene, errors)
    return Sweep(
        parameter="from the floor to a ball, in cells",
        measure="relative error",
        x=GAPS,
        chosen=("gather", errors["gather"]),
        others={"ddgi": errors["ddgi"]},
        promise="none",
    )


def polish(lab: Lab) -> Sweep:
    """Error of what a ball of metal shows of a room, by its roughness."""
    errors: dict[str, list[float]] = {"ddgi": [], "gather": []}
    for roughness in ROUGHNESSES:
        metal = {"type": "metal", "color": [0.9] * 3, "roughness": roughness}
        scene = room(sphere([0, 0, 0], 0.4, "steel"), {"position": [0, 0, 0.95], "fov": 40}, metal)
        _add_errors(lab, scene, errors)
    return Sweep(
        parameter="roughness of a ball of metal",
        measure="relative error",
        x=ROUGHNESSES,
        chosen=("ddgi", errors["ddgi"]),
        others={"gather": errors["gather"]},
        promise="none",
    )


def bulb(lab: Lab) -> Sweep:
    """Error of the light of a room, by the size of its lamp, whose flux is constant."""
    wrong: dict[str, list[float]] = {name: [] for name in ("ddgi", DIRECT)}
    eye = {"position": [0, 0, 0.9], "look_at": [0, -1, 0], "fov": 50}
    for radius in RADII:
        scene = room(sphere([0, 0.5, 0], radius, "lamp"), eye, light=lamp(0.4 / radius**2))
        truth = _light(lab, scene, lab.count(TRUE), method="mis", bounces=32)
        for name, bounces in (("ddgi", 32), (DIRECT, 1)):
            light = _light(lab, scene, lab.count(4 * SAMPLES), bounces=bounces)
            wrong[name].append(abs(light / truth - 1))
    return Sweep(
        parameter="radius of a lamp, of half the edge of its room",
        measure="relative error of the mean",
        x=RADII,
        chosen=("ddgi", wrong.pop("ddgi")),
        others=wrong,
        promise=f"at most {MOST_WRONG:g} at any size",
        bound=[MOST_WRONG] * len(RADII),
    )


def white(lab: Lab) -> Sweep:
    """The share that a closed room lacks of its light, 1 / (1 - a), by its albedo a."""
    lacking = []
    for albedo in ALBEDOS:
        room = scene_of([sphere([0, 0, 0], 1, "wall")], {"wall": lamp(1.0, albedo)})
        image = lab.render(room, lab.count(16), probes=3, **SETTINGS)
        lacking.append(abs(1 - mean_of(image)[0] * (1 - albedo)))
    return Sweep(
        parameter="share of light that walls absorb, 1 - albedo",
        measure="share of its light that is missing",
        x=[1 - albedo for albedo in ALBEDOS],
        chosen=("ddgi, warmed up by Chebyshev's weights", lacking),
        others={
            "as many updates that count whole": [a ** (PLAIN_UPDATES + 1) for a in ALBEDOS],
            "mis, 32 bounces": [a**33 for a in ALBEDOS],
        },
        promise=f"at most {MOST_LACKING:g} up to an albedo of {WHITEST:g}",
        bound=[MOST_LACKING] * len(ALBEDOS),
        guaranteed=[albedo <= WHITEST for albedo in ALBEDOS],
    )


def house(thickness: float, side: int, shift: float = HALF) -> Scene:
    """Two closed rooms; a lamp is in the left one, the camera sees the floor of one side.

    `shift`: from the middle of the wall between them to the nearest probes.
    """
    half = thickness / 2
    wall: Table = {"shape": "box", "min": [-half, -1, -1], "max": [half, 1, 1], "material": "m"}
    bulb = sphere([-1, 0.3, 0], 0.2, "lamp")
    eye = {"position": [side * 1.8, 0.5, 0.8], "look_at": [side * 0.8, -1, -0.1], "fov": 60}
    moved = shift - HALF
    probes = {"min": [moved - 2, -1, -1], "max": [moved + 2, 1, 1], "counts": [6, 3, 3]}
    materials = {"m": matte(0.5), "lamp": lamp(8.0)}
    return scene_of([*_shell(2), wall, bulb], materials, eye, probes=probes)


def room(thing: Table, eye: Table, steel: Table | None = None, light: Table = LAMP) -> Scene:
    """A closed room of 2 x 2 x 2 with a lamp, unless the thing in it is one."""
    bulb = [sphere([0, 0.6, 0.3], 0.15, "lamp")] if thing["material"] != "lamp" else []
    materials = {"m": matte(0.5), "lamp": light, **({"steel": steel} if steel else {})}
    probes = {"min": [-1, -1, -1], "max": [1, 1, 1], "counts": [5, 5, 5]}
    return scene_of([*_shell(1), *bulb, thing], materials, eye, probes=probes)


def _shell(wide: float) -> list[Table]:
    """Walls of a closed room from -`wide` to `wide`, 2 high and 2 deep."""
    return [
        *(quad([-wide, y, -1], [2 * wide, 0, 0], [0, 0, 2], "m") for y in (-1, 1)),
        *(quad([-wide, -1, z], [2 * wide, 0, 0], [0, 2, 0], "m") for z in (-1, 1)),
        *(quad([x, -1, -1], [0, 2, 0], [0, 0, 2], "m") for x in (-wide, wide)),
    ]


def _leaks(lab: Lab, scenes: list[Scene]) -> dict[str, list[float]]:
    """Light of dark rooms over that of the lit rooms next to them."""
    samples = lab.count(SAMPLES)
    lit = _light(lab, house(CELL, -1), samples)
    return {
        "ddgi": [_light(lab, scene, samples) / lit for scene in scenes],
        "ddgi without visibility": [_light(lab, s, samples, WITHOUT) / lit for s in scenes],
        "gather": [_light(lab, scene, samples, method="gather") / lit for scene in scenes],
    }


def _add_errors(lab: Lab, scene: Scene, errors: dict[str, list[float]]) -> None:
    """Append relative RMS errors by method: the part that two pictures share, which is no noise."""
    first, second = _pair(lab, scene, TRUE, 2, "mis")
    scale = np.square((first + second) / 2).mean()
    for method, found in errors.items():
        one, other = _pair(lab, scene, 4 * SAMPLES, 0, method)
        shared = ((one - first) * (other - second)).mean() / scale
        found.append(float(np.sqrt(max(shared, 0.0))))


def _pair(lab: Lab, scene: Scene, samples: int, seed: int, method: str) -> list[Array]:
    """Two pictures, with this seed and the next."""
    found = []
    with lab.rendering(scene, **{**SETTINGS, "method": method, "bounces": 32}) as renderer:
        for each in (seed, seed + 1):
            renderer.update(seed=each)
            image = renderer.render(lab.count(samples)).image()
            found.append(image.radiance.astype(np.float64))
    return found


def _light(lab: Lab, scene: Scene, samples: int, variant: Variant = PLAIN, **ways: Any) -> float:
    return mean_of(lab.render(scene, samples, variant, **{**SETTINGS, **ways}))[0]
