"""The `[animation]` table: which values of a scene change, and their keys."""

import tomllib
from typing import TYPE_CHECKING, Annotated, Any, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, PlainSerializer, PlainValidator, WithJsonSchema, model_validator

from glrt.core.text import quoted
from glrt.scene.animation.interpolation import QUATERNION, Interpolation, between
from glrt.scene.animation.rotations import angles
from glrt.scene.values import LARGEST, Number, Triple, Value

MOST_FRAMES = 1_000_000
TABLES = ("camera", "background", "sun", "lights", "materials", "media", "objects", "render")
NAMED = ("materials", "media", "objects")  # tables whose values have a name before their key
INNER = ("density", "transfer")  # tables of a medium whose values change
PHONG = ("render", "phong")  # the only table in [render] whose values change
ROTATION = "rotate"  # the key that takes a quaternion, too
_LONGEST = 500  # letters of a target
_NUMBER = {"type": "number"}
_EXAMPLE = 'camera.position, lights.lamp, materials.NAME.color or objects."my ball".center'


def parse_target(text: str) -> tuple[str, ...]:
    """Return the keys of a target such as `objects.ball.center`; ValueError if it is none.

    Names follow the rules of TOML's dotted keys: with other signs than letters, digits, - and _
    they stand in quotes.
    """
    try:
        table = tomllib.loads(f"{text} = 0") if len(text) <= _LONGEST else {}
    except tomllib.TOMLDecodeError:
        table = {}
    keys = list[str]()
    node: Any = table
    while isinstance(node, dict) and len(node) == 1:
        key, node = next(iter(node.items()))
        keys.append(key)
    if node != 0 or "\n" in text:
        raise ValueError(f"{quoted(text)} is not the name of a value, such as {_EXAMPLE}")
    is_inner = keys[0] == "media" and keys[2:3] in ([name] for name in INNER)
    wanted = 4 if is_inner else 3 if keys[0] in (*NAMED, PHONG[0]) else 2
    is_other = keys[0] == PHONG[0] and tuple(keys[:2]) != PHONG
    if keys[0] not in TABLES or len(keys) != wanted or is_other:
        raise ValueError(
            f"{quoted(text)} names no value that can change: it must be one of camera.KEY, "
            "background.KEY, sun.KEY, lights.GROUP, materials.NAME.KEY, media.NAME.KEY, "
            "media.NAME.density.KEY, objects.NAME.KEY and render.phong.KEY"
        )
    return tuple(keys)


def _key_value(value: Any) -> Any:
    """Accept a number, or a list of numbers."""
    items = value if isinstance(value, tuple) and value else (value,)
    for item in items:
        if isinstance(item, bool) or not isinstance(item, int | float):
            raise ValueError("must be a number, or a list of numbers")
        if not abs(item) <= LARGEST:
            raise ValueError(f"must have numbers from -{LARGEST:g} to {LARGEST:g}")
    return tuple(map(float, value)) if isinstance(value, tuple) else float(value)


KeyValue = Annotated[
    float | tuple[float, ...],
    PlainValidator(_key_value),
    PlainSerializer(lambda value: value, return_type=Any),
    WithJsonSchema({"anyOf": [_NUMBER, {"type": "array", "items": _NUMBER, "minItems": 1}]}),
]
Moment = Annotated[float, Field(ge=0, le=LARGEST)]


class Track(Value):
    """Keys of a value, and how it changes between them."""

    target: str = Field(
        description="the value: camera.KEY, background.KEY, sun.KEY, lights.GROUP, "
        "materials.NAME.KEY, media.NAME.KEY, media.NAME.density.KEY, objects.NAME.KEY or "
        'render.phong.KEY; a name with spaces or dots stands in "quotes"'
    )
    times: tuple[Moment, ...] = Field(
        min_length=1, description="times of the keys in seconds, each after the one before"
    )
    values: tuple[KeyValue, ...] = Field(
        min_length=1,
        description="value at each time, as the key takes it; rotate of an object also takes "
        "quaternions x y z w; whole numbers are rounded between keys",
    )
    interpolation: Interpolation = Field(
        "linear",
        description="between keys; linear: straight, and along the arc for quaternions; step: "
        "the value of the key before; cubic: a smooth curve through all keys",
    )

    if TYPE_CHECKING:

        def __init__(
            self,
            *,
            target: str,
            times: Triple,
            values: Any,
            interpolation: Interpolation = "linear",
        ) -> None: ...

    @model_validator(mode="after")
    def _has_keys(self) -> Self:
        parse_target(self.target)
        if len(self.times) != len(self.values):
            raise ValueError(
                f"has {len(self.times)} times and {len(self.values)} values; give one value for "
                "each time"
            )
        if any(late <= early for early, late in zip(self.times, self.times[1:], strict=False)):
            raise ValueError("times must grow from key to key")
        if len({_length(value) for value in self.values}) > 1:
            raise ValueError("values must have as many numbers each")
        return self

    @property
    def keys(self) -> tuple[str, ...]:
        """The keys of the target, such as ("objects", "ball", "center")."""
        return parse_target(self.target)

    def at(self, moment: float) -> float | tuple[float, ...]:
        """Return the value at a moment in seconds, as a scene file gives it."""
        rows = self._rows
        value = between(self.times, rows, moment, self.interpolation, self._is_rotation(rows[0]))
        return self._plain(value)

    @property
    def plain_values(self) -> list[float | tuple[float, ...]]:
        """The value of each key, as a scene file gives it."""
        return [self._plain(row) for row in self._rows]

    @property
    def _rows(self) -> NDArray[np.float64]:
        return np.array([np.atleast_1d(value) for value in self.values], np.float64)

    def _is_rotation(self, row: NDArray[np.float64]) -> bool:
        return self.keys[-1] == ROTATION and len(row) == QUATERNION

    def _plain(self, row: NDArray[np.float64]) -> float | tuple[float, ...]:
        if self._is_rotation(row):
            row = angles(row)
        numbers = tuple(float(number) for number in row)
        return numbers if isinstance(self.values[0], tuple) else numbers[0]


def _length(value: float | tuple[float, ...]) -> int:
    return len(value) if isinstance(value, tuple) else 0


class Animation(Value):
    """Values that change from frame to frame."""

    fps: float = Field(24.0, gt=0, le=1000, description="frames a second")
    start: Moment = Field(0.0, description="time of frame 0 in seconds")
    frames: int | None = Field(
        None,
        ge=1,
        le=MOST_FRAMES,
        description="number of frames; default: up to the last key, and one at least",
    )
    tracks: tuple[Track, ...] = Field((), description="the values, in tables [[animation.tracks]]")

    if TYPE_CHECKING:

        def __init__(
            self,
            *,
            fps: Number = 24.0,
            start: Number = 0.0,
            frames: int | None = None,
            tracks: Any = (),
        ) -> None: ...

    @model_validator(mode="after")
    def _moves_each_value_once(self) -> Self:
        seen = dict[tuple[str, ...], int]()
        for number, track in enumerate(self.tracks):
            other = seen.setdefault(track.keys, number)
            if other != number:
                raise ValueError(
                    f"tracks[{other}] and tracks[{number}] both change {track.target}: join them"
                )
        if self.frames is None and self._of_last_key >= MOST_FRAMES:
            raise ValueError(f"the last key is after {MOST_FRAMES:,} frames; give `frames`")
        return self

    @property
    def count(self) -> int:
        """The number of frames."""
        return int(max(self._of_last_key, 0)) + 1 if self.frames is None else self.frames

    @property
    def _of_last_key(self) -> float:
        """Number of the last frame that is not after the last key; a key may be 1e-6 early."""
        last = max((track.times[-1] for track in self.tracks), default=0.0)
        return (last - self.start) * self.fps + 1e-6

    def moment(self, frame: float) -> float:
        """Return the time in seconds of a frame, or of a share of the way to the next one."""
        return self.start + frame / self.fps
