"""The measurement of one scene: reference, number of rays, rounds, and the resulting curves."""

import hashlib
import json
import os
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from glrt.analysis.chart import flip
from glrt.analysis.chart.curves import Curve, curves_of
from glrt.analysis.chart.measure import Bench, Look, Round, Run
from glrt.analysis.chart.rays import Rays, rays_of
from glrt.analysis.chart.sights import Sight, sights_of
from glrt.analysis.reference import Budget, Reference, reference_for
from glrt.analysis.variants import (
    ADAPTIVE,
    LIVE,
    Variant,
    adaptive_of,
    live_variant,
    variants_of,
)
from glrt.core import files
from glrt.core.version import VERSION
from glrt.gpu.context import Context
from glrt.plan.plan import prepare
from glrt.rendering.schedule import is_within_limit
from glrt.scene.scene import Scene
from glrt.scene.scenefile.toml import scene_to_dict
from glrt.settings import Settings, settings_for


def key_of(scene: Scene, variants: Sequence[Variant], reference: Reference, place: str) -> str:
    """A hash of everything that rounds must have in common to be combined in one chart."""
    ways = [(it.name, it.settings.model_dump(mode="json"), it.hysteresis) for it in variants]
    truth = hashlib.sha256(reference.radiance.tobytes()).hexdigest()
    parts = [scene_to_dict(scene), ways, truth, place, flip.is_installed()]
    return hashlib.sha256(json.dumps(parts, sort_keys=True).encode()).hexdigest()[:32]


def load_rounds(path: Path | None, key: str) -> list[Round]:
    """The rounds in a file; empty if it is missing, damaged or of another measurement."""
    if path is None:
        return []
    try:
        data = json.loads(path.read_text(encoding="utf-8"))
        if data["key"] != key:
            return []
        return [
            [Run(name, [Look(*look) for look in looks], bias) for name, looks, bias in runs]
            for runs in data["rounds"]
        ]
    except (OSError, ValueError, KeyError, TypeError):
        return []


def save_rounds(path: Path | None, key: str, rounds: Sequence[Round]) -> None:
    """Write the rounds, replacing the file; without a path, do nothing."""
    if path is None:
        return
    text = json.dumps({"key": key, "rounds": rounds}) + "\n"
    files.write_text(path, text)


SAMPLER = "independent"  # of all variants whose names do not contain another one
REFERENCE_ERROR = 0.005  # relative RMS
REFERENCE_SHARE = 0.5  # most time for the reference, relative to that of the rounds

Tell = Callable[[str, float], None]  # called with the current step and the share of all work done


@dataclass(frozen=True)
class Plan:
    """How a scene is measured: height of the frame in pixels, rounds, seconds for all rounds."""

    height: int = 64
    rounds: int = 5
    seconds: float = 60.0
    named: tuple[str, ...] = ()  # curves that the user wants in the picture

    def settings(self, scene: Scene) -> Settings:
        """The settings that the variants of a scene change."""
        return settings_for(frame_of(scene, self.height), sampler=SAMPLER)

    def variants(self, scene: Scene) -> list[Variant]:
        """All variants of a scene; a machine's loop limit may leave some out.

        Adaptive sampling is among them if it is named, and so are live probes, which need many
        updates before each picture.
        """
        settings = self.settings(scene)
        asked = [adaptive_of(settings)] if ADAPTIVE in self.named else []
        live = live_variant(scene, settings) if LIVE in self.named else ()
        return [*variants_of(scene, settings), *asked, *live]


@dataclass(frozen=True)
class Experiment:
    """The results of one scene."""

    name: str
    title: str
    rounds: int  # number of rounds
    reference: Reference
    variants: tuple[Variant, ...]
    curves: tuple[Curve, ...]  # one per variant, in the same order
    rays: tuple[Rays, ...]  # of each variant
    place: str  # version, driver, number of processors
    named: tuple[str, ...] = ()  # curves that the user wants in the picture
    sights: tuple[Sight, ...] = ()  # pictures with the errors of LEVELS

    @property
    def size(self) -> tuple[int, int]:
        """Width and height of the frame in pixels."""
        height, width, _ = self.reference.radiance.shape
        return width, height


def measure_scene(
    name: str, scene: Scene, plan: Plan, context: Context, rounds_file: Path | None, report: Tell
) -> Experiment:
    """Measure a scene; rounds that `rounds_file` holds from an earlier run are not repeated.

    Without such a file, an interrupted measurement is lost.
    """
    settings = plan.settings(scene)
    variants = [
        variant
        for variant in plan.variants(scene)
        if is_within_limit(context, prepare(scene, variant.settings))
    ]
    place = f"glrt {VERSION}, {context.renderer}, {os.cpu_count()} processors"
    allowed = REFERENCE_SHARE * plan.seconds
    whole = allowed + plan.seconds

    def report_reference(share: float) -> None:
        report(f"{name}: reference", share * allowed / whole)

    budget = Budget(REFERENCE_ERROR, allowed)
    reference = reference_for(scene, settings, context, budget, report_reference)
    rays = tuple(_rays_of(scene, variant, context) for variant in variants)
    key = key_of(scene, variants, reference, place)
    rounds = load_rounds(rounds_file, key)

    def report_round(share: float) -> None:
        text = f"{name}: round {len(rounds) + 1} of {plan.rounds}"
        report(text, (allowed + share * plan.seconds) / whole)

    bench = Bench(scene, variants, reference, context)
    for done in _missing_rounds(bench, plan, rounds, len(variants), report_round):
        save_rounds(rounds_file, key, done)
    curves = tuple(curves_of(_in_order(rounds, variants), reference.error))
    sights = tuple(sights_of(bench, curves, reference))
    bench.release()
    title, found = scene.title or name, tuple(variants)
    measured = (reference, found, curves, rays, place)
    return Experiment(name, title, len(rounds), *measured, plan.named, sights)


def _rays_of(scene: Scene, variant: Variant, context: Context) -> Rays:
    rays = rays_of(scene, variant.settings, context)
    return rays if variant.hysteresis is None else Rays(rays.sample, once=rays.of_update())


def frame_of(scene: Scene, height: int) -> Settings:
    """The settings of a scene for a frame of this height, with the aspect ratio of the scene."""
    wish = scene.render
    width = max(1, round(height * wish.width / wish.height))
    return settings_for(wish, width=width, height=height, adaptive="off")


def _missing_rounds(
    bench: Bench, plan: Plan, rounds: list[Round], variants: int, report: Callable[[float], None]
) -> Iterator[list[Round]]:
    """Measure the rounds that the plan still lacks; append each to `rounds` and yield the list."""
    missing = plan.rounds - len(rounds)
    for number in range(missing):
        runs: Round = []
        for runs in bench.round(len(rounds), plan.seconds / plan.rounds):
            report((number + len(runs) / variants) / missing)
        rounds.append(runs)
        yield rounds


def _in_order(rounds: Sequence[Round], variants: Sequence[Variant]) -> list[Round]:
    """The rounds with their runs in the order of the variants."""
    names = [variant.name for variant in variants]
    return [sorted(runs, key=lambda run: names.index(run.variant)) for runs in rounds]
