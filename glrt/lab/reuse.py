"""Reuse of points where neighbours do not see the same."""

from typing import Any

from glrt.lab.scenes import lamp, matte, quad, scene_of
from glrt.lab.sweep import Lab, Sweep, mean_of
from glrt.scene.scene import Scene

HEIGHTS = (0.01, 0.03, 0.1, 0.3, 0.9)  # heights of slats
APART = 0.1
SAMPLES = 512
MOST_WRONG = 0.02
SETTINGS: dict[str, Any] = {"width": 32, "height": 32, "sampler": "sobol", "bounces": 2}
WAYS: dict[str, dict[str, Any]] = {  # without probes' light: `mis` has the truth
    "spatial": {"reuse": "spatial"},
    "both, biased": {"reuse": "both", "unbiased": False},
    "spatial, biased": {"reuse": "spatial", "unbiased": False},
    "both": {"reuse": "both"},
}


def slats(lab: Lab) -> Sweep:
    """Error of the light of a floor between slats, by their height."""
    wrong: dict[str, list[float]] = {way: [] for way in WAYS}
    for height in HEIGHTS:
        scene = floor(height)
        truth = _light(lab, scene, 4, method="mis")
        for way, settings in WAYS.items():
            light = _light(lab, scene, 1, method="resampled", **settings)
            wrong[way].append(abs(light / truth - 1))
    return Sweep(
        parameter="height of slats, of the distance between them",
        measure="relative error of the mean",
        x=[height / APART for height in HEIGHTS],
        chosen=("spatial", wrong.pop("spatial")),
        others=wrong,
        promise=f"at most {MOST_WRONG:g} at any height",
        bound=[MOST_WRONG] * len(HEIGHTS),
    )


def floor(height: float) -> Scene:
    """A floor with slats of this height, in a room with a lamp under its ceiling."""
    walls = [
        *(quad([-1, y, -1], [2, 0, 0], [0, 0, 2], "m") for y in (-1, 1)),
        *(quad([-1, -1, z], [2, 0, 0], [0, 2, 0], "m") for z in (-1, 1)),
        *(quad([x, -1, -1], [0, 2, 0], [0, 0, 2], "m") for x in (-1, 1)),
    ]
    stand = [quad([APART * i - 0.5, -1, -0.6], [0, 0, 0.9], [0, height, 0], "m") for i in range(11)]
    bulb = quad([-0.4, 0.9, -0.4], [0.8, 0, 0], [0, 0, 0.8], "lamp")
    eye = {"position": [0, -0.2, 0.6], "look_at": [0, -1, -0.2]}
    return scene_of([*walls, *stand, bulb], {"m": matte(0.7), "lamp": lamp(8.0)}, eye)


def _light(lab: Lab, scene: Scene, times: int, **ways: Any) -> float:
    return mean_of(lab.render(scene, times * lab.count(SAMPLES), **SETTINGS, **ways))[0]
