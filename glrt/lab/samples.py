"""How pixels get their samples: as many as their noise asks for, or shared with neighbours."""

import math
from typing import Any

from glrt.error.estimate import relative_error
from glrt.lab.scenes import lamp, matte, quad, scene_of, sphere
from glrt.lab.sweep import Lab, Sweep
from glrt.scene.scene import Scene

SIDE = 64  # of a picture, in pixels
SAMPLES = 256  # of a pixel, on average
TRUTH = 16  # times as many samples of the reference
SLACK, GAIN, SMALL = 1.05, 0.85, 0.25  # times the error of equal counts; from a share of SMALL on
LOSS, LESS, WIDE = 1.05, 0.95, 8  # times the error of sobol; from a width of WIDE pixels on


def uneven(lab: Lab) -> Sweep:
    """Error of a picture by the share of it that has noise, the rest is black."""
    x = [1.0, 0.5, 0.25, 0.1, 0.04, 0.01]
    samples = lab.count(SAMPLES, least=128)
    equal: list[float] = []
    own: list[float] = []
    for share in x:
        scene = _wall(math.sqrt(share))
        ways: dict[str, Any] = {"width": SIDE, "height": SIDE, "bounces": 1, "sampler": "sobol"}
        truth = lab.render(scene, TRUTH * samples, seed=1, **ways).radiance
        for found, choice in ((equal, "off"), (own, "on")):
            image = lab.render(scene, samples, adaptive=choice, **ways)
            error = relative_error(truth, image.radiance - truth)
            assert error is not None
            found.append(error)
    return Sweep(
        parameter="share of the picture that is lit, the rest is black",
        measure=f"relative RMS error at {samples} samples",
        x=x,
        chosen=("--adaptive on: counts by the noise of neighbours", own),
        others={"equal counts": equal},
        promise=f"at most {SLACK:g} times the error of equal counts, {GAIN:g} up to {SMALL:g}",
        bound=[(GAIN if part <= SMALL else SLACK) * e for part, e in zip(x, equal, strict=True)],
    )


def neighbours(lab: Lab) -> Sweep:
    """Error of pixels that share random numbers, by the width of objects; the light is the same."""
    x = [1, 2, 4, 8, 16, 64]
    samples = lab.count(SAMPLES, least=256)
    ways: dict[str, Any] = {"width": SIDE, "height": SIDE, "bounces": 1}
    truth = lab.render(_stripes(1), TRUTH * samples, seed=1, **ways).radiance

    def error_of(width: int, sampler: str) -> float:
        image = lab.render(_stripes(SIDE // width), samples, sampler=sampler, **ways)
        error = relative_error(truth, image.radiance - truth)
        assert error is not None
        return error

    own, alike = error_of(SIDE, "sobol"), [error_of(width, "shared") for width in x]
    return Sweep(
        parameter="width of objects, in pixels",
        measure=f"relative RMS error at {samples} samples",
        x=x,
        chosen=("--sampler shared", alike),
        others={"--sampler sobol": [own] * len(x)},
        promise=f"at most {LOSS:g} times the error of sobol, {LESS:g} from {WIDE} pixels on",
        bound=[(LESS if width >= WIDE else LOSS) * own for width in x],
    )


def _stripes(count: int) -> Scene:
    """Return upright matte stripes, each an object, lit by a lamp that a ball hides in part."""
    width = 2 / count
    lefts = [-1 + width * number for number in range(count)]
    return scene_of(
        [
            *(quad([left, -1, -1], [width, 0, 0], [0, 2, 0], "white") for left in lefts),
            sphere([0.4, 0.5, -0.4], 0.25, "white"),
            sphere([0.9, 1.2, 0.6], 0.5, "lamp"),
        ],
        {"white": matte(0.8), "lamp": lamp(4.0)},
        {"fov": 90},
    )


def _wall(edge: float) -> Scene:
    """Return a matte square, `edge` of the view along both sides, lit from behind the camera."""
    return scene_of(
        [
            quad([-edge, -edge, -1], [2 * edge, 0, 0], [0, 2 * edge, 0], "white"),
            sphere([0.5, 2.0, 1.0], 0.8, "lamp"),
        ],
        {"white": matte(0.8), "lamp": lamp(4.0)},
        {"fov": 90},
    )
