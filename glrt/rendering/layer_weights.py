"""Weighted sums of film layers: the picture under other lamp intensities, with particles."""

from typing import NamedTuple

import moderngl
import numpy as np

from glrt.gpu.canvas import Canvas
from glrt.gpu.glsl import Source
from glrt.gpu.program import drawing
from glrt.image.film_state import FilmState, empty_state, keep
from glrt.image.layer_sums import LayerSums
from glrt.plan.plan import MOST_LAYERS, NONE, Weights, are_trivial
from glrt.rendering.film import Exposure, Film, standard_error
from glrt.rendering.pass_film import Array

_VERSION = "410 core"


class Reading(NamedTuple):
    """One pixel of a film under weights."""

    radiance: Array  # (3,) float32
    stderr: Array  # (3,) float32, NaN below two observations
    samples: int  # finite ones


def read_row(film: Film, weights: Weights, y: int) -> tuple[Exposure, Array, Array]:
    """Row y of a film, and its radiance and standard error under weights, (1, W, 3) each."""
    row = film.read(slice(y, y + 1))
    return row, *_mixed(row, weights)


def mixed(film: Film, weights: Weights) -> tuple[Array, Array, FilmState | None]:
    """Radiance and standard error under weights, (H, W, 3) float32 each, and the film state.

    The film state is None if the film has layers, or if the weights are not all 1: no render can
    continue from that picture.
    """
    width, height = film.size
    radiance, error = np.empty((2, height, width, 3), np.float32)
    is_all = are_trivial(weights) and not film.extent.layers
    film_state = empty_state(height, width, film.extent.groups) if is_all else None
    for rows in film.bands():
        exposure = film.read(rows)
        radiance[rows], error[rows] = _mixed(exposure, weights)
        if film_state:
            keep(film_state, rows, exposure.state(film.samples))
    if film_state:
        film_state = film_state._replace(counts=film.counts, shares=film.shares)
    return radiance, error, film_state


def gathered(film: Film, weights: Weights) -> FilmState | LayerSums:
    """The statistics of a film under weights that a denoiser needs; no render continues from them.

    They are the film state, scaled by the weight. For weighted layers they are sums over two halves
    of the observations.
    """
    width, height = film.size
    factors = np.array(weights, np.float32)
    bands = [film.read(rows) for rows in film.bands()]
    if film.extent.layers and not are_trivial(weights):
        sums = (_sums(band, factors) for band in bands)
        return LayerSums(*(np.concatenate(part, axis=1) for part in zip(*sums, strict=True)))
    state, factor = empty_state(height, width), factors[0]
    for rows, band in zip(film.bands(), bands, strict=True):
        own = band.state(film.samples)
        own = own._replace(variance=own.variance * factor**2, part=own.part * factor)
        keep(state, rows, own)
    return state


def _mixed(film: Exposure, weights: Weights) -> tuple[Array, Array]:
    """Radiance and standard error of some rows under weights, (H, W, 3) each.

    Errors of layers are correlated. So the error of a sum is taken from the means a and b over two
    halves of the observations: |a - b| sqrt(n_a n_b) / n. It has one degree of freedom, so it is
    rough for one pixel, but not for the picture.
    """
    if are_trivial(weights):
        return film.mean, standard_error(film)
    factors = np.array(weights, np.float32)
    if not film.layers.size:
        return film.mean * factors[0], standard_error(film) * factors[0]
    sums = _sums(film, factors)
    error = np.sqrt(sums.variance)
    error[film.observations < 2] = np.nan
    return sums.mean, error


def _sums(film: Exposure, factors: Array) -> LayerSums:
    counts = film.layers[:, 0, :, :, 3:].astype(np.float64)
    weighted = film.layers[..., :3] * factors[:, None, None, :]
    return LayerSums(weighted.sum(axis=1, dtype=np.float64), counts)


class Mixer:
    """Computes the weighted sum on the driver, for the display pass."""

    def __init__(self, gl: moderngl.Context) -> None:
        """Nothing is compiled before it is needed."""
        self._gl = gl
        self._program: moderngl.Program | None = None
        self._canvas = Canvas(gl, "f4")

    def draw(
        self, film: Film, weights: Weights, particles: moderngl.Texture | None = None
    ) -> moderngl.Texture:
        """The film's mean, or a texture of its weighted sum; valid until the next call.

        The light of `particles` is added, if given.
        """
        is_plain = are_trivial(weights)
        if is_plain and not particles:
            return film.mean
        program = self._program or self._compile()
        film.mean.use(0)
        program["mean"] = 0
        if film.layers:
            film.layers.use(1)
            program["layers"] = 1
        program["has_particles"] = particles is not None
        if particles:
            particles.use(2)
            program["particles"] = 2
        program["layer_count"] = 0 if is_plain else film.extent.layers
        program["weights"] = [*weights, *[NONE] * (MOST_LAYERS - len(weights))]
        with self._gl.scope(self._canvas.sized(film.size)):
            self._quad.render(moderngl.TRIANGLE_STRIP, vertices=4)
        assert self._canvas.texture
        return self._canvas.texture

    def release(self) -> None:
        """Release all OpenGL resources."""
        self._canvas.release()
        if self._program:
            self._quad.release()
            self._program.release()

    def _compile(self) -> moderngl.Program:
        vertex, fragment = (
            Source("display.vert", version=_VERSION),
            Source("weighting.frag", version=_VERSION),
        )
        self._program = drawing(self._gl, vertex, fragment)
        self._quad = self._gl.vertex_array(self._program, [])
        return self._program
