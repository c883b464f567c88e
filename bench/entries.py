"""Who takes part in a contest: glrt as `glrt render` makes long renders, and Mitsuba at its best.

Mitsuba renders with its own materials; its `roughconductor` does not correlate the shadowing of
both directions, as glrt does, so that pictures of very rough metal differ: errors are taken about
each renderer's own mean. A trial finds its fastest settings: roulette
or none, independent or multijittered samples. Mitsuba gets planes of two triangles and one-sided
lamps, where these do not show.
"""

import sys
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from bench.contest import Array, seconds_to
from bench.peer import Peer, Request
from bench.turns import Command, Entry, interleaved, samples_for, started
from glrt.cli.sampler import LEAST, sampler_for
from glrt.samplers import DIVISIONS
from glrt.scene.scene import Scene

TARGET_ERROR = 0.02  # relative RMS
MOST = 8191  # samples: four of the blocks that longer renders have take too long for a turn
TRIAL_ROUNDS = 4
TRIAL_SECONDS = 1.0  # of a render
TRIAL_SEED = 1000  # the first one of trials: choices are not made by the renders that count
MULTIJITTER_BLOCK = 64  # samples; tests/mitsuba renders its pictures in blocks of them
GLRT, MITSUBA, WGSL = "glrt", "Mitsuba", "WGSL"
PEERS = {
    GLRT: [sys.executable, "-m", "bench.glrt_peer"],
    MITSUBA: [sys.executable, "-m", "tests.mitsuba.serve"],
    WGSL: [sys.executable, "-m", "tests.wgsl.serve"],
}


def request(scene: Scene, size: int, **asked: Any) -> Request:
    """A request for a scene up to its own limit of bounces; its samples are set later."""
    sides = {"width": size, "height": size}
    return Request.of(scene, **sides, bounces=scene.render.bounces, samples=1, seed=0, **asked)


def ours(scene: Scene, size: int, sampler: str = "sobol") -> Entry:
    """glrt with its default method and without particles."""
    asked = request(scene, size, method="mis", sampler=sampler)
    return Entry(f"glrt mis, {sampler}", GLRT, asked, DIVISIONS[sampler].block)


def by_default(scene: Scene, size: int, samples: int = LEAST) -> Entry:
    """glrt as `glrt render` makes long renders of so many samples.

    It has the blocks that `--sampler auto` takes for MOST samples at most, and particles where they
    pay.
    """
    sampler = sampler_for(min(samples, MOST))
    asked = request(scene, size, method="mis", sampler=sampler, chooses=True)
    return Entry(f"glrt, {sampler}", GLRT, asked, DIVISIONS[sampler].block)


def alike(scene: Scene, size: int) -> list[Entry]:
    """glrt and the WGSL version with the only method that both have."""
    plain = {"method": "naive", "sampler": "independent", "roulette": False}
    asked = request(scene, size, **plain)
    return [Entry("glrt naive", GLRT, asked), Entry(WGSL, WGSL, asked)]


def mitsubas(scene: Scene, size: int, is_one_sided: bool) -> Iterator[Entry]:
    """Mitsuba in each way that may be its best."""
    fast = {"one_sided": is_one_sided, "finite": True, "native": True}
    for sampler, block in (("independent", 1), ("multijitter", MULTIJITTER_BLOCK)):
        for text, roulette in (("roulette", True), ("no roulette", False)):
            asked = request(scene, size, sampler=sampler, roulette=roulette, **fast)
            yield Entry(f"Mitsuba, {text}, {sampler}", MITSUBA, asked, block)


def level_of(peers: Mapping[str, Peer], entry: Entry, seconds: float) -> Array:
    """A picture with little noise, (H, W, 3), to which variances are relative."""
    contender = entry.contender(peers)
    return contender.render(samples_for(contender, seconds), 0)[0].astype(np.float64)


def samples_to(error: float, peers: Mapping[str, Peer], entry: Entry, level: Array) -> int:
    """Samples per pixel with which an entry reaches a relative RMS error, by a trial."""
    (runs,) = interleaved([entry.contender(peers)], TRIAL_ROUNDS, TRIAL_SECONDS, TRIAL_SEED)
    return int(runs.variances(level).mean() / error**2)


def best_mitsuba(
    commands: Mapping[str, Command],
    scene: Scene,
    size: int,
    level: Array,
    seconds: float = TRIAL_SECONDS,
    is_one_sided: bool = False,
) -> Entry:
    """The way in which Mitsuba takes the least time to an error, by a trial."""
    entries = list(mitsubas(scene, size, is_one_sided))
    with started({MITSUBA: commands[MITSUBA]}) as peers:
        contenders = [entry.contender(peers) for entry in entries]
        runs = interleaved(contenders, TRIAL_ROUNDS, seconds, TRIAL_SEED)
    times = [seconds_to(TARGET_ERROR, each, level) for each in runs]
    return entries[times.index(min(times))]
