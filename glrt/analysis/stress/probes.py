"""Probes: light through thin walls, and rooms that hardly absorb."""

from typing import Any

from glrt.analysis.stress.scenes import Table, lamp, matte, quad, scene_of, sphere
from glrt.analysis.stress.sweep import Lab, Sweep, mean_of
from glrt.rendering.pipelines import PLAIN, Variant
from glrt.scene.scene import Scene

SETTINGS: dict[str, Any] = {"width": 16, "height": 16, "sampler": "sobol", "method": "ddgi"}
SAMPLES = 64
CELL = 2 / 3  # edge of a cell
THICKNESSES = (0.01, 0.1, 0.25, 0.5)  # of a wall, in cells
TIGHT = 0.25  # thickness from which on a wall holds
MOST_LEAKED = 0.002
WITHOUT = {"without visibility": Variant({"WITHOUT_VISIBILITY": True})}

ALBEDOS = (0.5, 0.8, 0.9, 0.95, 0.98, 0.99)
WHITEST, MOST_LACKING = 0.95, 0.012
PLAIN_UPDATES = 32  # that one set of probes takes


def leak(lab: Lab) -> Sweep:
    """Light of a sealed dark room over that of the floor of the lit one beside it."""
    found: dict[str, list[float]] = {name: [] for name in ("ddgi", *WITHOUT)}
    samples = lab.count(SAMPLES)
    lit = _light(lab, house(CELL, -1), samples)
    for thickness in THICKNESSES:
        for name, values in found.items():
            variant = WITHOUT.get(name, PLAIN)
            values.append(_light(lab, house(thickness * CELL, 1), samples, variant) / lit)
    return Sweep(
        parameter="thickness of the wall, in cells",
        measure="light behind a wall over that before it",
        x=THICKNESSES,
        chosen=("ddgi", found.pop("ddgi")),
        others=found,
        promise=f"at most {MOST_LEAKED:g} from a thickness of {TIGHT:g} cells on",
        bound=[MOST_LEAKED] * len(THICKNESSES),
        guaranteed=[thickness >= TIGHT for thickness in THICKNESSES],
    )


def white(lab: Lab) -> Sweep:
    """What a closed room lacks of its light, 1 / (1 - a), by its albedo a."""
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


def house(thickness: float, side: int) -> Scene:
    """Two closed rooms; a lamp is in the left one, the camera sees the floor of one side."""
    half = thickness / 2
    wall: Table = {"shape": "box", "min": [-half, -1, -1], "max": [half, 1, 1], "material": "m"}
    shell = [
        *(quad([-2, y, -1], [4, 0, 0], [0, 0, 2], "m") for y in (-1, 1)),
        *(quad([-2, -1, z], [4, 0, 0], [0, 2, 0], "m") for z in (-1, 1)),
        *(quad([x, -1, -1], [0, 2, 0], [0, 0, 2], "m") for x in (-2, 2)),
    ]
    bulb = sphere([-1, 0.3, 0], 0.2, "lamp")
    eye = {"position": [side * 1.8, 0.5, 0.8], "look_at": [side * 0.8, -1, -0.1], "fov": 60}
    probes = {"min": [-2, -1, -1], "max": [2, 1, 1], "counts": [6, 3, 3]}
    materials = {"m": matte(0.5), "lamp": lamp(8.0)}
    return scene_of([*shell, wall, bulb], materials, eye, probes=probes)


def _light(lab: Lab, scene: Scene, samples: int, variant: Variant = PLAIN) -> float:
    return mean_of(lab.render(scene, samples, variant, **SETTINGS))[0]
