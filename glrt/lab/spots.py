"""Spots: the edges of narrow cones, and one spot that lights a place among many that do not."""

import math

import numpy as np

from glrt.lab.lamps import CHOSEN, EVENLY, RECEIVED, tolerance
from glrt.lab.scenes import Table, matte, plane, scene_of, sphere
from glrt.lab.sweep import Array, Lab, Sweep
from glrt.rendering.shader_functions import World
from glrt.scene.lights.cone import Cone
from glrt.scene.scene import Scene


def cone(lab: Lab) -> Sweep:
    """Error of the share of a spot's emission across the edge of its cone."""
    x = np.logspace(-2.5, 2, 10)
    rows = lab.count(1 << 12)
    cosine = "dot(direction, emitter_at(0).axis)"
    ways = {
        "glrt: 1 - cos as half a squared difference": "emitted(material_at(0), direction, true).x",
        "textbook: cos as a dot product": f"share_in_cone(1.0 - {cosine}, outer, slope)",
    }
    errors: dict[str, list[float]] = {name: [] for name in ways}
    for outer in x:
        spot = Cone(axis=(0.6, -0.64, 0.48), inner=float(outer) / 2, outer=float(outer))
        towards = _towards(spot, rows)
        low, high = spot.versines
        fields = {"outer": np.full(rows, high), "slope": np.full(rows, 1 / (high - low))}
        # The second of two emitters; the first is that of lamps without a cone.
        for name, what in ways.items():
            found = lab.path(
                what.replace("emitter_at(0)", "emitter_at(1)"),
                {"direction": towards, **fields},
                World(scene_of([sphere([0, 0, -3], 1, "spot")], {"spot": _spot(spot)})),
            )
            truth = spot.shares(towards.astype(np.float64))
            errors[name].append(float(np.abs(found - truth).max()))
    first, *others = errors.items()
    return Sweep(
        parameter="outer half angle of the cone in degrees",
        measure="error of the share that is emitted\n(largest)",
        x=x.tolist(),
        chosen=first,
        others=dict(others),
        promise="at most what the rounding of a direction does: 8e-7 over the angle in radians",
        bound=[8e-7 / math.radians(min(outer, 60)) for outer in x],
    )


def _towards(spot: Cone, count: int) -> Array:
    """Unit vectors across the edge of a cone, (n, 3) float32."""
    random = np.random.default_rng(4)
    angle = np.radians(spot.outer) * random.uniform(0.4, 1.1, count)
    turn = random.uniform(0, 2 * np.pi, count)
    axis = spot.unit_axis
    aside = np.cross(axis, [0.36, 0.48, 0.8])
    aside /= np.linalg.norm(aside)
    around = np.cos(turn)[:, None] * aside + np.sin(turn)[:, None] * np.cross(axis, aside)
    found = np.cos(angle)[:, None] * axis + np.sin(angle)[:, None] * around
    units: Array = found / np.linalg.norm(found, axis=1, keepdims=True)
    return units.astype(np.float32)


def spots(lab: Lab) -> Sweep:
    """Noise of one sample with one spot that lights a place among others that light another."""
    x = [1 << power for power in range(11)]
    rows = np.arange(lab.count(1 << 15, 1 << 13))
    ways = {"glrt: by where the light goes": CHOSEN, "uniform": EVENLY}
    noise: dict[str, list[float]] = {name: [] for name in ways}
    wrong = []
    for count in x:
        scene = _ring(count)
        for name, setup in ways.items():
            light = lab.path(RECEIVED, {"x": rows}, World(scene), setup=setup).astype(np.float64)
            noise[name].append(float(light.std() / light.mean()))
            if setup == CHOSEN and abs(light.mean() / _flux() - 1) > tolerance(light) + _ROUNDED:
                wrong.append(count)
    first, *others = noise.items()
    return Sweep(
        parameter="spots, one of them aimed here",
        measure="relative noise of one sample",
        x=x,
        chosen=first,
        others=dict(others),
        promise="at most 0.01; the mean within 5.3 standard errors",
        bound=[0.01] * len(x),
        wrong=wrong,
    )


_RADIUS, _HEIGHT = 1e-3, 2.0
_ROUNDED = 1e-5


def _ring(count: int) -> Scene:
    """A spot above the origin, and count - 1 spots around it that are aimed outwards."""
    balls = [sphere([0, _HEIGHT, 0], _RADIUS, "here")]
    materials: dict[str, Table] = {
        "here": _spot(Cone(axis=(0, -1, 0), inner=10, outer=20)),
        "white": matte(0.5),
    }
    for number in range(1, count):
        turn = 2 * math.pi * number / count
        x, z = math.cos(turn), math.sin(turn)
        materials[f"{number}"] = _spot(Cone(axis=(x, -0.5, z), inner=10, outer=20))
        balls.append(sphere([x, _HEIGHT, z], _RADIUS, f"{number}"))
    return scene_of([plane([0, 0, 0], [0, 1, 0], "white"), *balls], materials)


def _flux() -> float:
    """Irradiance at the origin: PI L r^2 / d^2 of a small ball straight above."""
    return math.pi * (_RADIUS / _HEIGHT) ** 2


def _spot(spot: Cone) -> Table:
    return {"type": "light", "emission": [1.0] * 3, "cone": spot.model_dump()}
