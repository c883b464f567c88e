"""The film: running mean and variance of each pixel, in ping-pong textures."""

from collections.abc import Iterator
from typing import NamedTuple

import moderngl
import numpy as np

from glrt.core.errors import RenderError, UsageError
from glrt.gpu.glsl import read
from glrt.gpu.program import Resource
from glrt.gpu.structs import read_constants
from glrt.image.allotment import NO_COUNTS, NO_SHARES, Counts
from glrt.image.film_state import FilmState, error_of_mean
from glrt.image.group_channels import NO_GROUPS
from glrt.rendering.pass_film import Array, PassFilm, Size
from glrt.rendering.pipelines import RESERVOIRS
from glrt.settings import Settings

BAND_PIXELS = 1 << 17  # pixels read at a time: 2 MiB of a texture
_RESERVOIRS = read_constants(read("probes/reservoir.glsl"))
COLUMNS, ROWS = (_RESERVOIRS[f"{name}_OF_RESERVOIR"] for name in ("COLUMNS", "ROWS"))  # texels


class Extent(NamedTuple):
    """The size of a film, and what it keeps per pixel."""

    width: int
    height: int
    block: int = 1  # samples per observation
    layers: int = 0
    reservoirs: bool = False  # whether samples keep light points for later ones
    groups: int = 0  # of shared numbers
    points: int = 0  # successive samples of such a group; 0 without

    @classmethod
    def of(cls, settings: Settings, layers: int, reservoirs: bool) -> "Extent":
        """The extent of a film for settings."""
        division = settings.division
        groups = division.groups, division.points if division.is_shared else 0
        return cls(*settings.size, settings.block, layers, reservoirs, *groups)


class Exposure(NamedTuple):
    """A film read back: arrays (H, W, 3) float32, row 0 on top."""

    mean: Array
    variance: Array  # variance of one observation
    dropped: Array  # (H, W): samples that were not finite
    observations: Array  # (H, W): complete ones
    part: Array  # mean of the samples after the last complete observation
    share: Array  # (H, W): fraction of the finite samples that is in `part`
    layers: Array  # (2, layers, H, W, 4): radiance and samples, by halves of observations
    groups: Array = NO_GROUPS  # (groups, H, W, 4): radiance and samples, of shared numbers

    def state(self, samples: int) -> FilmState:
        """The film state, without mean and layers; each pixel has `samples`."""
        begun = np.rint(self.share * (samples - self.dropped))
        parts = self.variance, self.dropped, self.observations, self.part, begun
        return FilmState(*parts, self.groups if len(self.groups) else NO_GROUPS)


class Film(PassFilm):
    """Pairs of RGBA32F textures for mean and variance: a dispatch reads one, writes the other.

    If an observation takes more than one sample, another pair holds the incomplete observation.
    Groups of shared numbers have a texture each. A dispatch adds to one of them: it writes a spare
    one, which takes the place of the group's.
    Layers of light have a pair, with separate sums for two halves of the observations. Reservoirs
    have a pair too (shaders_glsl/probes/reservoir.glsl).
    """

    def __init__(self, gl: moderngl.Context, extent: Extent) -> None:
        """Allocate the textures; RenderError if the driver has no room."""
        self.extent = extent
        self.counts: Counts = NO_COUNTS  # samples of each pixel, where they differ
        self.shares: Array = NO_SHARES  # of pixels in further samples, then
        self._held: set[int] = set()  # groups with samples
        what = f"a film of {extent.width} x {extent.height} pixels"
        self._groups: list[moderngl.Texture] = []
        super().__init__(gl, what, _outputs(extent))
        if extent.points:
            self._add_groups()

    @property
    def size(self) -> Size:
        """Width and height in pixels."""
        return self.extent.width, self.extent.height

    @property
    def mean(self) -> moderngl.Texture:
        """The texture of the picture's mean so far."""
        return self.sources["mean"]

    @property
    def variance(self) -> moderngl.Texture:
        """The texture of the variance of one observation so far."""
        return self.sources["variance"]

    @property
    def layers(self) -> moderngl.Texture | None:
        """The layers side by side: one half of the observations above, the other half below."""
        return self.sources.get("layers")

    @property
    def resources(self) -> dict[str, Resource]:
        """Textures that a kernel reads at any pixel, not at its own alone."""
        held = self.sources.get("reservoirs")
        return {RESERVOIRS: held} if held else {}

    def at_once(self, samples: int) -> int:
        """How many of `samples` one dispatch can add: of shared numbers, those of a block at most.

        It is 1 if samples read each other's reservoirs.
        """
        samples = min(samples, self.extent.points or samples)
        return 1 if self.extent.reservoirs else samples

    def next_at_once(self, samples: int) -> int:
        """How many of `samples` the next dispatch can add, so that it ends with a block at most."""
        points = self.extent.points
        return min(samples, points - self.next_sample % points) if points else samples

    def images(self) -> dict[str, moderngl.Texture]:
        """The textures by the names of the kernel's images: `source_NAME` and `target_NAME`.

        The block is that of the group of the next sample.
        """
        found = super().images()
        if self._group in self._held:
            found["source_block"] = self._groups[self._group]
        return found

    def advance(self, samples: int) -> None:
        """Complete a frame of `samples` per pixel: the target textures become the sources."""
        group = self._group
        super().advance(samples)
        if self.extent.points:
            self._held.add(group)
            (written, zeros), spare = (it["block"] for it in self._pairs), self._groups[group]
            self._pairs[0]["block"], self._pairs[1]["block"] = zeros, spare
            self._groups[group] = written

    def release(self) -> None:
        """Release the textures."""
        super().release()
        for texture in self._groups:
            texture.release()

    def _add_groups(self) -> None:
        """Allocate the groups; the source of the block is of those without samples."""
        width, height = self.size
        self.sources["block"].write(np.zeros((height, width, 4), np.float32))
        try:
            for _ in range(self.extent.groups):
                self._groups.append(self._texture(self.size))
        except RenderError:
            self.release()
            raise

    @property
    def _group(self) -> int:
        """The group of shared numbers that the next sample belongs to."""
        points = self.extent.points
        return self.next_sample // points % self.extent.groups if points else 0

    def read(self, rows: slice = slice(None)) -> Exposure:
        """Copy the film or some of its rows into memory; RenderError if it has no samples."""
        self._check_exposed()
        first, end, _ = rows.indices(self.size[1])
        mean, variance = (self.read_output(name, first, end) for name in ("mean", "variance"))
        begun = self._read_begun(mean[..., 3], first, end)
        dropped = self.taken(rows) - mean[..., 3]
        parts = mean[..., :3], variance[..., :3], dropped, variance[..., 3], *begun
        kept = self._read_layers(first, end), self._read_groups(first, end)
        copies = (part.copy() for part in (*parts, *kept))
        return Exposure(*copies)

    def dropped(self) -> int:
        """Number of samples that were not finite, over all pixels."""
        self._check_exposed()
        ends = ((rows, rows.indices(self.size[1])[:2]) for rows in self.bands())
        lost = (self.taken(rows) - self.read_output("mean", *end)[..., 3] for rows, end in ends)
        return sum(int(band.sum(dtype=np.float64)) for band in lost)

    def taken(self, rows: slice) -> Array:
        """Samples of the pixels of some rows, (rows, width) float32, or (1, 1) if all are equal."""
        equal = np.full((1, 1), self.samples, np.float32)
        return self.counts[rows].astype(np.float32) if self.counts.size else equal

    def bands(self) -> Iterator[slice]:
        """Slices of rows that cover the film; each takes little memory."""
        rows = max(1, BAND_PIXELS // self.size[0])
        return (slice(first, first + rows) for first in range(0, self.size[1], rows))

    def write(self, samples: int, mean: Array, film_state: FilmState) -> None:
        """Continue from a picture with `samples` per pixel: write its mean and its film state.

        Raises UsageError for a film with layers, since a picture does not hold them.
        """
        if self.extent.layers:
            raise UsageError("layers of light are kept here, which a picture does not hold")
        self.samples, self.counts, self.shares = samples, film_state.counts, film_state.shares
        finite = self.taken(slice(None)) - film_state.dropped
        rows = {
            "mean": np.dstack([mean, finite]),
            "variance": np.dstack([film_state.variance, film_state.observations]),
            "block": np.dstack([film_state.part, film_state.begun]),
        }
        if self.extent.points:
            for texture, means in zip(self._groups, film_state.groups, strict=True):
                texture.write(np.ascontiguousarray(means))
            self._held = {k for k, it in enumerate(film_state.groups) if it[..., 3].any()}
            del rows["block"]
        for name in self.sources.keys() & rows:
            self.sources[name].write(np.ascontiguousarray(rows[name], np.float32))

    def restart(self, first_sample: int = 0) -> None:
        """Discard all samples; the next dispatch ignores what the textures hold."""
        super().restart(first_sample)
        self.counts, self.shares = NO_COUNTS, NO_SHARES
        self._held = set()

    def _check_exposed(self) -> None:
        if not self.samples:
            raise RenderError("the film is empty: render a sample first")

    def _read_begun(self, finite: Array, first: int, end: int) -> tuple[Array, Array]:
        """Mean of the incomplete observation, and its share of the `finite` samples per pixel."""
        is_whole = self.counts.size or self.samples % self.extent.block == 0
        if self.extent.groups or is_whole:
            return np.zeros((*finite.shape, 3), np.float32), np.zeros_like(finite)
        begun = self.read_output("block", first, end)
        return begun[..., :3], np.asarray(begun[..., 3] / np.maximum(finite, 1), np.float32)

    def _read_groups(self, first: int, end: int) -> Array:
        """The means of groups of shared numbers, (groups, rows, width, 4)."""
        groups = range(self.extent.groups)
        found = [self._read_group(number, first, end) for number in groups]
        return np.array(found, np.float32) if found else NO_GROUPS

    def _read_group(self, number: int, first: int, end: int) -> Array:
        """The means of a group of shared numbers, (rows, width, 4)."""
        held = self._groups[number] if number in self._held else self.sources["block"]
        return self._rows(held, first, end)

    def _read_layers(self, first: int, end: int) -> Array:
        (width, height), count = self.size, self.extent.layers
        if not self.layers:
            return np.zeros((2, 0, end - first, width, 4), np.float32)
        halves = [self.read_output("layers", up + first, up + end) for up in (0, height)]
        return np.stack(halves).reshape(2, end - first, count, width, 4).swapaxes(1, 2)


def _outputs(extent: Extent) -> dict[str, Size]:
    """The textures of a film and their sizes."""
    width, height, block, layers, has_reservoirs, _, _ = extent
    sizes = dict.fromkeys(("mean", "variance"), (width, height))
    sizes |= {"block": (width, height)} if block > 1 else {}
    sizes |= {"reservoirs": (COLUMNS * width, ROWS * height)} if has_reservoirs else {}
    return sizes | ({"layers": (layers * width, 2 * height)} if layers else {})


def standard_error(film: Exposure) -> Array:
    """Standard error of each pixel's mean, (H, W, 3) float32; NaN below two observations."""
    return error_of_mean(film.mean, film.variance, film.observations, film.part, film.share)
