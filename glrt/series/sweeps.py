"""Values from one number to another, for `--sweep KEY=FROM:TO:N`."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from glrt.core.text import number, quoted
from glrt.scene.animation.tracks import PHONG, parse_target
from glrt.scene.frames import holds_whole
from glrt.scene.schema.fields import SceneFields
from glrt.settings import Settings

SETTINGS = "render"  # the table of a key that is a setting
MOST_STEPS = 10_000
_ROUNDING = 1e-14  # relative error of a step
_OF_SIZE = ("width", "height")  # all frames of a film are of one size


@dataclass(frozen=True)
class Sweep:
    """A value of a scene, or a setting as ("render", "bounces"), in steps of equal size."""

    keys: tuple[str, ...]
    start: tuple[float, ...]
    end: tuple[float, ...]
    steps: int

    @property
    def name(self) -> str:
        """The key, as the user wrote it, without quotes."""
        return ".".join(self.keys)

    def value(self, step: int) -> float | tuple[float, ...]:
        """Return the value of a step, from 0; the first and the last are exact."""
        share = step / (self.steps - 1) if self.steps > 1 else 0.0
        ends = zip(self.start, self.end, strict=True)
        found = tuple(_between(low, high, share) for low, high in ends)
        return found if len(found) > 1 else found[0]

    @property
    def text(self) -> str:
        """The sweep, as the user writes it."""
        return self._written(self.start, self.end, self.steps)

    def _written(self, start: tuple[float, ...], end: tuple[float, ...], steps: int) -> str:
        low, high = (",".join(map(_short, ends)) for ends in (start, end))
        return f"{self.name}={low}:{high}:{steps}"

    @property
    def broken(self) -> float | None:
        """The first value with a fraction; None if all are whole."""
        values = (self.value(step) for step in range(self.steps))
        numbers = (x for value in values for x in (value if isinstance(value, tuple) else (value,)))
        return next((x for x in numbers if not x.is_integer()), None)

    @property
    def whole(self) -> str:
        """The nearest sweep whose values are all whole, as the user writes it."""
        low, high = (tuple(float(round(x)) for x in ends) for ends in (self.start, self.end))
        gap = math.gcd(*(int(b - a) for a, b in zip(low, high, strict=True)))
        wanted = self.steps - 1
        fitting = (n for n in range(1, min(gap, MOST_STEPS - 1) + 1) if gap % n == 0)
        nearest = min(fitting, key=lambda n: (abs(n - wanted), -n), default=wanted)
        return self._written(low, high, nearest + 1 if wanted else 1)

    def label(self, step: int) -> str:
        """Return the last key and the value of a step, for people."""
        value = self.value(step)
        numbers = value if isinstance(value, tuple) else (value,)
        return f"{self.keys[-1]} {' '.join(map(_short, numbers))}"


def _between(low: float, high: float, share: float) -> float:
    """Return the number at a share of the way; a whole one if only rounding parts it from that."""
    value = (1 - share) * low + share * high
    near = float(round(value))
    return near if abs(value - near) <= _ROUNDING * max(abs(low), abs(high)) else value


def _short(value: float) -> str:
    """Return a number for people: whole ones in full, others with six digits that count."""
    return str(int(value)) if value.is_integer() else number(float(f"{value:.6g}"))


def parse_sweep(text: str) -> Sweep:
    """Parse `KEY=FROM:TO:N`; ValueError says what is wrong."""
    key, equals, range_ = text.rpartition("=")
    parts = range_.split(":")
    if not equals or len(parts) != len(("FROM", "TO", "N")):
        raise ValueError(
            f"{quoted(text)} is not KEY=FROM:TO:N, such as materials.ball.roughness=0:1:5"
        )
    start, end = (_numbers(part, text) for part in parts[:2])
    if len(start) != len(end):
        raise ValueError(f"{quoted(text)}: FROM and TO must have as many numbers each")
    try:
        steps = int(parts[2])
    except ValueError:
        steps = 0
    if not 1 <= steps <= MOST_STEPS:
        raise ValueError(f"{quoted(text)}: N must be a whole number from 1 to {MOST_STEPS:,}")
    return Sweep(_keys(key.strip()), start, end, steps)


def _keys(text: str) -> tuple[str, ...]:
    table, _, name = text.partition(".")
    if table != SETTINGS or name.partition(".")[0] == PHONG[1]:
        return parse_target(text)
    known = sorted(_numeric_settings())
    if name not in known:
        wanted = ", ".join([*known, "phong.KEY"])
        raise ValueError(f"{quoted(text)}: a sweep can change {wanted} of render")
    return (SETTINGS, name)


def _numeric_settings() -> Sequence[str]:
    fields = Settings.model_fields.items()
    is_number = (name for name, field in fields if field.annotation in (int, float))
    return [name for name in is_number if name not in _OF_SIZE]


def _numbers(text: str, whole: str) -> tuple[float, ...]:
    try:
        return tuple(float(part) for part in text.split(","))
    except ValueError:
        raise ValueError(
            f"{quoted(whole)}: FROM and TO must be numbers, or as many numbers with commas between"
        ) from None


def is_setting(keys: tuple[str, ...]) -> bool:
    """Return whether a value is a setting of the render; others are values of the scene."""
    return keys[0] == SETTINGS and keys[:2] != PHONG


def is_whole(scene: SceneFields, keys: tuple[str, ...]) -> bool:
    """Return whether a value is a whole number; `SceneError` if the scene lacks it."""
    if is_setting(keys):
        return Settings.model_fields[keys[1]].annotation is int
    return keys[0] != "lights" and holds_whole(scene, keys)


def setting_changes(values: dict[tuple[str, ...], Any]) -> dict[str, Any]:
    """Return the settings among values by key; whole values of counts are integers."""
    found = {keys[1]: value for keys, value in values.items() if is_setting(keys)}
    counts = {name for name in found if Settings.model_fields[name].annotation is int}
    return {name: int(v) if name in counts and v.is_integer() else v for name, v in found.items()}
