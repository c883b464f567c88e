"""Draw numbers of pixels as colours: errors, dropped samples, differences, history, distances.

The error of a pixel is its part of the picture's error: the mean square over pixels is the square
of `glrt.error.estimate.estimated_error`.
"""

import math
from dataclasses import dataclass, replace
from typing import Any, Literal, NamedTuple

import moderngl
import numpy as np
from numpy.typing import ArrayLike, NDArray

from glrt.error.estimate import DARK, LUCK, UNSURE
from glrt.gpu.glsl import Source, read
from glrt.gpu.program import drawing
from glrt.gpu.structs import read_constants
from glrt.plan.plan import MOST_LAYERS, NONE, ONE, Weights, are_trivial
from glrt.rendering.film import Film

Color = tuple[float, float, float]  # sRGB, 0..1

SHOWS = read_constants(read("false_colors.frag"))

_VERSION = "410 core"


def _colors(codes: str) -> tuple[Color, ...]:
    """Colours from hexadecimal codes."""
    parts = [bytes.fromhex(code) for code in codes.split()]
    return tuple((red / 255, green / 255, blue / 255) for red, green, blue in parts)


# Even steps to the eye, also with red-green blindness. CC0: Smith and van der Walt, 2015.
VIRIDIS = _colors(
    "440154 482475 414487 355f8d 2a788e 21918c 22a884 44bf70 7ad151 bddf26 fde725",
)
# Dark at both ends, white in the middle: ColorBrewer's RdBu, Apache-2.0: Brewer, 2002.
BLUE_WHITE_RED = _colors(
    "053061 2166ac 4393c3 92c5de d1e5f0 f7f7f7 fddbc7 f4a582 d6604d b2182b 67001f",
)
YELLOW_TO_RED = _colors(
    "ffff66 fff05c ffe052 ffcf48 ffbd3e ffaa35 ff962c ff8023 ff681b ff4b14 ff1f0f",
)


Number = Literal["history", "weight", "mask"]


class Told(NamedTuple):
    """A number of each pixel of the history that is shown: `a` of a texture."""

    texture: moderngl.Texture
    least: float  # a pixel whose number is not above it has none


@dataclass(frozen=True)
class Scale:
    """The colours of numbers from `low` to `high`; beyond them, the colour of that end."""

    colors: tuple[Color, ...]
    low: float
    high: float
    is_logarithmic: bool = True

    def share(self, numbers: ArrayLike) -> NDArray[np.float64]:
        """Positions of numbers on the scale, from 0 to 1."""
        number = np.clip(np.asarray(numbers, np.float64), self.low, self.high)
        if self.is_logarithmic:
            return np.asarray(np.log(number / self.low) / math.log(self.high / self.low))
        return np.asarray((number - self.low) / (self.high - self.low))

    def color(self, numbers: ArrayLike) -> NDArray[np.float64]:
        """Colours of numbers (...) as (..., 3) sRGB, mixed between two colours of the scale."""
        share, steps = self.share(numbers), np.linspace(0.0, 1.0, len(self.colors))
        channels = [np.interp(share, steps, channel) for channel in np.transpose(self.colors)]
        return np.stack(channels, axis=-1)


ERROR = Scale(VIRIDIS, 0.001, 1.0)
DROPPED = Scale(YELLOW_TO_RED, 1.0, 1000.0)
HISTORY = Scale(VIRIDIS, 1.0, 64.0)
WEIGHT = Scale(VIRIDIS, 0.001, 1.0)
MASK = Scale(VIRIDIS, 1.0, 3.0, is_logarithmic=False)
DIFFERENCE = Scale(BLUE_WHITE_RED, -0.5, 0.5, is_logarithmic=False)


def symmetric(scale: Scale, most: float) -> Scale:
    """The scale with limits -most and most."""
    return replace(scale, low=-most, high=most)


class FalseColors:
    """Draws statistics of a film in false colours, on the framebuffer in use."""

    def __init__(self, gl: moderngl.Context) -> None:
        """Nothing is compiled before it is needed."""
        self._gl = gl
        self._program: moderngl.Program | None = None

    def draw_error(
        self, film: Film, light: moderngl.Texture, weights: Weights, mean: float
    ) -> None:
        """Draw the relative error of each pixel of `light`, the film's radiance under weights.

        `mean` is that of the radiance, over pixels and channels.
        """
        values: dict[str, Any] = {"shows": SHOWS["SHOWS_ERROR"], "dark": DARK * mean**2}
        values |= {"unsure": UNSURE, "luck": LUCK}
        if not are_trivial(weights):
            values["layer_count"] = film.extent.layers
            values["weights"] = [*weights, *[NONE] * (MOST_LAYERS - len(weights))]
        self._draw(film, light, light, ERROR, values)

    def draw_dropped(self, film: Film, light: moderngl.Texture) -> None:
        """Draw how many samples of each pixel were not finite, over a dark picture."""
        self._draw(film, light, light, DROPPED, {"shows": SHOWS["SHOWS_DROPPED"]})

    def draw_difference(
        self,
        film: Film,
        light: moderngl.Texture,
        other: moderngl.Texture,
        mean: float,
        scale: Scale = DIFFERENCE,
    ) -> None:
        """Draw (Y - Y') / sqrt(Y'^2 + 0.01 mean^2) of luminances; Y' and `mean` are the other's."""
        values = {"shows": SHOWS["SHOWS_DIFFERENCE"], "dark": DARK * mean**2}
        self._draw(film, light, other, scale, values)

    def draw_history(self, film: Film, light: moderngl.Texture, told: Told, scale: Scale) -> None:
        """Draw a number of the history of each pixel; grey where there is none."""
        values = {"shows": SHOWS["SHOWS_HISTORY"], "least": told.least}
        self._draw(film, light, told.texture, scale, values)

    def draw_distances(
        self, film: Film, light: moderngl.Texture, balls: moderngl.Texture, scale: Scale
    ) -> None:
        """Draw the distances of probes, as `ProbeBalls` draws them, over a dark picture."""
        values = {"shows": SHOWS["SHOWS_PROBES"], "least": -0.5}
        self._draw(film, light, balls, scale, values)

    def release(self) -> None:
        """Release program and quad."""
        if self._program:
            self._quad.release()
            self._program.release()

    def _draw(
        self,
        film: Film,
        light: moderngl.Texture,
        other: moderngl.Texture,
        scale: Scale,
        values: dict[str, Any],
    ) -> None:
        program = self._program or self._compile()
        parts = [light, film.mean, film.variance, film.layers or film.mean, other]
        for unit, texture in enumerate(parts):
            texture.use(unit)
        plain = {"layer_count": 0, "weights": [ONE] * MOST_LAYERS, "dark": 0.0, "least": 0.0}
        plain |= {"unsure": 0.0, "luck": 1.0}
        plain["samples"] = film.samples
        range_ = {"is_logarithmic": scale.is_logarithmic, "range": (scale.low, scale.high)}
        for name, value in {**plain, **range_, "colors": scale.colors, **values}.items():
            program[name] = value
        self._quad.render(moderngl.TRIANGLE_STRIP, vertices=4)

    def _compile(self) -> moderngl.Program:
        self._program = drawing(
            self._gl,
            Source("display.vert", version=_VERSION),
            Source("false_colors.frag", version=_VERSION),
        )
        for unit, name in enumerate(("light", "mean", "variance", "layers", "other")):
            self._program[name] = unit
        self._quad = self._gl.vertex_array(self._program, [])
        return self._program
