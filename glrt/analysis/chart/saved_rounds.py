"""The rounds of a measurement in a file, so that an interruption loses at most one round."""

import hashlib
import json
from collections.abc import Sequence
from pathlib import Path

from glrt.analysis.chart import flip
from glrt.analysis.chart.measure import Look, Round, Run
from glrt.analysis.reference import Reference
from glrt.analysis.variants import Variant
from glrt.core import files
from glrt.scene.scene import Scene
from glrt.scene.scenefile.toml import scene_to_dict


def key_of(scene: Scene, variants: Sequence[Variant], reference: Reference, place: str) -> str:
    """A hash of everything that rounds must have in common to be combined in one chart."""
    ways = [(variant.name, variant.settings.model_dump(mode="json")) for variant in variants]
    truth = hashlib.sha256(reference.radiance.tobytes()).hexdigest()
    parts = [scene_to_dict(scene), ways, truth, place, flip.is_installed()]
    return hashlib.sha256(json.dumps(parts, sort_keys=True).encode()).hexdigest()[:32]


def load_rounds(path: Path, key: str) -> list[Round]:
    """The rounds in a file; empty if it is missing, damaged or of another measurement."""
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


def save_rounds(path: Path, key: str, rounds: Sequence[Round]) -> None:
    """Write the rounds, replacing the file."""
    text = json.dumps({"key": key, "rounds": rounds}) + "\n"
    files.write_text(path, text)
