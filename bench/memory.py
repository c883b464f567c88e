"""The memory of a process that renders a large picture, and what it is used for.

Each process renders `cornell` at 1 sample per pixel and saves it as EXR. The memory for a picture
of 8 x 8 pixels is that of the interpreter and the driver. The film holds all its textures twice.
The picture holds everything that is needed to resume the render.
"""

import sys
from collections.abc import Iterator, Sequence
from typing import NamedTuple, get_args

from bench.cold_start import PROGRAMS, start_of
from bench.program import exit_code_of, machine, parser_of
from glrt.core.errors import RenderError
from glrt.image.sources import load
from glrt.settings import Sampler, settings_for

SMALL = 8  # pixels a side
TEXEL = 16  # bytes of RGBA32F
PICTURE = 40  # bytes per pixel: radiance, standard error, variance, observations
BEGUN = 16  # additional bytes for an incomplete block of Sobol' points: its mean and samples


class Row(NamedTuple):
    """The memory of one render, in bytes."""

    size: int  # pixels a side
    sampler: Sampler
    seconds: float  # of the process
    peak: float  # of the process
    base: float  # peak with a small picture
    film: int
    picture: int

    @property
    def rest(self) -> float:
        """The part of the peak that film, picture and the peak with a small picture leave."""
        return self.peak - self.base - self.film - self.picture


def measure(size: int, sampler: Sampler) -> Row:
    """Render a small and a large picture, each in a process; raises RenderError if one fails."""
    small, large = (_start(pixels, sampler) for pixels in (SMALL, size))
    settings = settings_for(load("cornell").render, sampler=sampler)
    block = settings.block
    textures = 2 * (2 if block == 1 else 3)  # mean, variance, incomplete block; all twice
    picture = PICTURE + (BEGUN if block > 1 else 0)
    if groups := settings.division.groups:  # in place of an incomplete block
        textures, picture = 6 + groups, PICTURE + groups * TEXEL
    film, picture = textures * TEXEL * size**2, picture * size**2
    return Row(size, sampler, large[0], large[1], small[1], film, picture)


def _start(size: int, sampler: Sampler) -> tuple[float, float]:
    edges = ["--width", str(size), "--height", str(size)]
    work = ["cornell", *edges, "--samples", "1", "--sampler", sampler]
    start = start_of(PROGRAMS["glrt"], work)
    if start is None:
        raise RenderError(f"a render of {size} x {size} pixels failed; is there memory for it?")
    return start


def table(rows: Sequence[Row]) -> Iterator[str]:
    """The rows as Markdown, memory in MiB."""
    yield "| size | sampler | process time | peak memory | small picture | film | picture | other |"
    yield "|---|---|---|---|---|---|---|---|"
    for row in rows:
        sizes = (row.peak, row.base, row.film, row.picture, row.rest)
        cells = " | ".join(f"{size / 2**20:.0f}" for size in sizes)
        yield f"| {row.size} x {row.size} | {row.sampler} | {row.seconds:.1f} s | {cells} |"


def main(arguments: list[str] | None = None) -> int:
    """`python -m bench.memory`; returns the exit code."""
    parser = parser_of("memory", __doc__)
    parser.add_argument("--size", type=int, default=4096, metavar="N", help="default: 4096")
    parsed = parser.parse_args(arguments)
    return exit_code_of(lambda: _print(parsed.size))


def _print(size: int) -> None:
    rows = [measure(size, sampler) for sampler in get_args(Sampler)]
    print(f"{machine()}, MiB\n")
    print("\n".join(table(rows)))


if __name__ == "__main__":
    sys.exit(main())
