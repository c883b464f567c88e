"""How often the judgement on an estimated error is wrong, on scenes that nobody looked at before.

`python -m bench.doubt` prints the table of docs/results/stress.md: pictures of random scenes
(bench/scenes.py) and of scenes made to fool the estimate (bench/fooling_scenes.py), 48 x 36 pixels,
at 64 and 256 samples, against two halves of 1,024 samples by `mis` of other seeds: the product of
the distances to both is the squared error without the noise of the truth. Directly seen light
of lamps that few of those samples meet is taken from 4,096 samples a half without bounces. The
scenes are drawn from a seed that is a hash of the code of the judgement, so none of them can have
been used to choose it.
"""

import hashlib
import math
import os
import sys
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

import glrt.error
from bench.false_alarms import markdown, wilson
from bench.fooling_scenes import KINDS, fooling_scene
from bench.program import at_least, exit_code_of, machine, parser_of
from bench.scenes import random_scene
from glrt.error.estimate import DARK
from glrt.gpu.context import open_context
from glrt.image.image import Image
from glrt.rendering.renderer import Renderer
from glrt.scene.scene import Scene
from glrt.settings import Method

Array = NDArray[np.float64]

SIZE: dict[str, Any] = {"width": 48, "height": 36}
BOUNCES = 6  # at most
LOOKS = (64, 256)  # samples
HALF, HALF_SEEDS = 1024, (1 << 20, (1 << 20) + 1)  # of a reference
DIRECT = 4096  # samples of what is seen of lamps without a bounce, a half
SMALL_LAMP = 3.0  # pixels across: what is seen of a smaller one is taken from DIRECT samples
NEE_EVERY = 6  # of so many random scenes one is rendered by `nee`
RANDOM = "random"
WRONG, RIGHT = 2.0, 1.3  # true error over the estimate: not to be believed, to be believed
HEAD = (
    "scenes",
    "pictures",
    "above 2",
    "of them not cautioned",
    "within 1.3 times",
    "of them cautioned",
)


class Task(NamedTuple):
    """A scene to render."""

    kind: str
    number: int
    seed: int


class Finding(NamedTuple):
    """A picture that was judged."""

    kind: str
    seed: int
    samples: int
    ratio: float  # of the true error to the estimate
    is_doubtful: bool | None

    @property
    def is_right(self) -> bool:
        """Whether the estimate is to be believed: neither too small nor too large."""
        return 1 / RIGHT < self.ratio < RIGHT


def frozen_seed() -> int:
    """A seed from the code that judges, and from that which estimates."""
    files = sorted(Path(glrt.error.__file__).parent.glob("*.py"))
    text = b"".join(file.read_bytes() for file in files)
    return int.from_bytes(hashlib.sha256(text).digest()[:4], "big")


def tasks(seed: int, count: int, fooling: int) -> list[Task]:
    """So many random scenes, and so many made to fool, the kinds in turn."""
    kinds = list(KINDS)
    made = [Task(kinds[k % len(kinds)], k, seed + k) for k in range(fooling)]
    return [*made, *(Task(RANDOM, k, seed + k) for k in range(count))]


def findings(task: Task) -> list[Finding]:
    """The pictures of a scene, one for each of LOOKS."""
    if task.kind == RANDOM:
        method: Method = "nee" if task.number % NEE_EVERY == NEE_EVERY - 1 else "mis"
        scene = random_scene(task.seed)
    else:
        scene, method = fooling_scene(task.kind, task.seed)
    context = open_context()
    size = {**SIZE, "bounces": min(BOUNCES, scene.render.bounces)}
    renderer = Renderer(scene, context=context, method=method, seed=1, **size)
    images = [renderer.render(samples).image() for samples in LOOKS]
    if method != "mis":
        renderer.release()
        renderer = Renderer(scene, context=context, method="mis", **size)
    halves = [_half(renderer, seed, has_small_lamp(scene)) for seed in HALF_SEEDS]
    renderer.release()
    context.gl.release()
    return [
        Finding(task.kind, task.seed, image.samples, ratio, image.error_doubtful)
        for image in images
        if (ratio := true_ratio(image, halves)) is not None
    ]


def _half(renderer: Renderer, seed: int, is_sharp: bool) -> Array:
    """Half of a reference, (H, W, 3); `is_sharp`: with more samples of what is seen directly.

    Without bounces the same samples see the same of lamps: their noise is taken away with it.
    """
    bounces = renderer.settings.bounces
    renderer.update(seed=seed)
    half = _radiance(renderer, HALF)
    if is_sharp:
        renderer.update(bounces=0)
        half -= _radiance(renderer, HALF)
        half += _radiance(renderer, DIRECT)
        renderer.update(bounces=bounces)
    return half


def _radiance(renderer: Renderer, samples: int) -> Array:
    return renderer.render(samples).image().radiance.astype(np.float64)


def has_small_lamp(scene: Scene) -> bool:
    """Whether some lamp is so small in the picture that few samples meet it."""
    eye, pixel = np.array(scene.camera.position), 2 / SIZE["height"]
    slope = math.tan(math.radians(scene.camera.fov) / 2)
    lamps = [shape for shape in scene.visible if any(scene.emission_of(shape))]
    return any(
        2 * lamp.reach < SMALL_LAMP * pixel * slope * math.dist(lamp.middle, eye) for lamp in lamps
    )


def true_ratio(image: Image, halves: Sequence[Array]) -> float | None:
    """The true error of a picture over the estimated one; None without noise."""
    if not image.error:
        return None
    first, second = halves
    truth = (first + second) / 2
    squares = (image.radiance - first) * (image.radiance - second)
    squared = float((squares / (np.square(truth) + DARK * truth.mean() ** 2)).mean())
    return math.sqrt(max(squared, 0.0)) / image.error


def row(name: str, found: Sequence[Finding]) -> list[str]:
    """A row of the table."""
    wrong = [finding for finding in found if finding.ratio > WRONG]
    right = [finding for finding in found if finding.is_right]
    missed = sum(not finding.is_doubtful for finding in wrong)
    alarms = sum(bool(finding.is_doubtful) for finding in right)
    return [
        name,
        str(len(found)),
        str(len(wrong)),
        f"{missed} ({_rate(missed, len(wrong))}; of all pictures {_rate(missed, len(found))})",
        str(len(right)),
        f"{alarms} ({_rate(alarms, len(right))}; of all pictures {_rate(alarms, len(found))})",
    ]


def _rate(count: int, total: int) -> str:
    if not total:
        return "-"
    low, high = wilson(count, total)
    return f"{100 * count / total:.1f} %, {100 * low:.1f} to {100 * high:.1f}"


def main(arguments: list[str] | None = None) -> int:
    """`python -m bench.doubt`; returns the exit code."""
    parser = parser_of("doubt", __doc__)
    for name, default in (("random", 200), ("fooling", 40)):
        told = f"number of {name} scenes (default: {default})"
        parser.add_argument(f"--{name}", type=at_least(0), default=default, metavar="N", help=told)
    told = "seed of the first scene (default: from the code that judges)"
    parser.add_argument("--seed", type=at_least(0), metavar="SEED", help=told)
    parsed = parser.parse_args(arguments)
    seed = frozen_seed() if parsed.seed is None else parsed.seed
    return exit_code_of(lambda: _print(tasks(seed, parsed.random, parsed.fooling)))


def _print(work: list[Task]) -> None:
    # A process that was forked from one with OpenGL open may wait for ever.
    with ProcessPoolExecutor(os.cpu_count(), mp_context=get_context("spawn")) as pool:
        found = [finding for part in pool.map(findings, work) for finding in part]
    first = min((task.seed for task in work), default=0)
    print(f"{machine()}, {SIZE['width']} x {SIZE['height']} pixels, scenes from seed {first} on\n")
    print(report(found))


def report(found: Sequence[Finding]) -> str:
    """The table, and a line for each picture that was judged wrongly."""
    kinds = [kind for kind in (RANDOM, *KINDS) if any(one.kind == kind for one in found)]
    rows = [row(kind, [one for one in found if one.kind == kind]) for kind in kinds]
    lines = [markdown(list(HEAD), [*rows, row("all", found)]), ""]
    for one in found:
        is_missed = one.ratio > WRONG and not one.is_doubtful
        if is_missed or (one.is_right and one.is_doubtful):
            told = "cautioned" if one.is_doubtful else "not cautioned"
            lines += [
                f"{one.kind}, seed {one.seed}, {one.samples} samples: {one.ratio:.2f}, {told}"
            ]
    return "\n".join(lines)


if __name__ == "__main__":
    sys.exit(main())
