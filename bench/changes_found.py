"""Whether `glrt compare` finds changes of the size that it says it would have found.

`python -m bench.changes_found` prints a table of docs/results/compare.md: for each pair of renders,
a change of each kind is planted at the size that the comparison of the pair as it is reports. A
change "found" makes the verdict "different". 64 x 48 pixels, Sobol' points.
"""

import sys
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from bench.false_alarms import ALPHA, markdown
from bench.methods_compared import HEIGHT, REFERENCE_SEED, WIDTH, renders
from bench.program import at_least, exit_code_of, machine, parser_of
from glrt.cli.compare import light_groups
from glrt.comparison.regions import BLOCK, Array
from glrt.comparison.result import percent
from glrt.comparison.verdict import compare
from glrt.gpu.context import Context, open_context
from glrt.image.image import Image
from glrt.image.sources import load
from glrt.settings import Method

HEAD = ["scene", "methods", "samples", "change", "median size", "found"]
SCENES = ("cornell", "lamps", "sky", "metals")
REFERENCES = 20


@dataclass(frozen=True)
class Pairing:
    """A scene and how its two pictures are rendered: method and samples."""

    scene: str
    image: tuple[Method, int]
    reference: tuple[Method, int]


class Planted(NamedTuple):
    """A change of one kind in one pair: its size, and whether it was found."""

    kind: str
    size: float
    is_found: bool


def pairings() -> list[Pairing]:
    """The rows of the table."""
    kinds: list[tuple[tuple[Method, int], tuple[Method, int]]] = [
        (("mis", 32), ("mis", 1024)),
        (("mis", 256), ("mis", 256)),
        (("nee", 256), ("mis", 256)),
    ]
    return [Pairing(scene, *kind) for scene in SCENES for kind in kinds]


def changes(image: Image, groups: dict[str, Image], place: int) -> dict[str, Array]:
    """What is added to a picture, at size 1, of each kind; the block is the `place`-th."""
    light = image.radiance.astype(np.float64)
    row, column = divmod(place % (HEIGHT // BLOCK * (WIDTH // BLOCK)), WIDTH // BLOCK)
    inside = np.s_[BLOCK * row : BLOCK * (row + 1), BLOCK * column : BLOCK * (column + 1)]
    block = np.zeros_like(light)
    block[inside] = light[inside]
    lamps = {f"light group {k}": v.radiance.astype(np.float64) for k, v in groups.items()}
    return {"all light": light, "one block": block} | (lamps if len(groups) > 1 else {})


def planted(image: Image, reference: Image, groups: dict[str, Image], place: int) -> list[Planted]:
    """A change of each kind at the size that is said to be found."""
    found = compare(image, reference, ALPHA, groups=groups).sensitivity
    sizes = {"all light": found.light, "one block": found.block}
    sizes |= {f"light group {name}": size for name, size in found.groups.items()}
    rows = []
    for kind, change in changes(image, groups, place).items():
        size = sizes.get(kind, np.inf)
        if np.isfinite(size) and change.any():
            radiance = (image.radiance + size * change).astype(np.float32)
            told = compare(replace(image, radiance=radiance), reference, ALPHA)
            rows.append(Planted(kind, size, not told))
    return rows


def experiment(context: Context, pairing: Pairing, pairs: int) -> Iterator[list[str]]:
    """The rows of a pairing."""
    scene = load(pairing.scene)
    references = list(renders(context, scene, pairing.reference, REFERENCES, REFERENCE_SEED))
    groups = light_groups(references[0], pairing.scene)
    images = renders(context, scene, pairing.image, pairs, 0)
    rows = [
        row
        for k, image in enumerate(images)
        for row in planted(image, references[k % REFERENCES], groups, k)
    ]
    for kind in dict.fromkeys(row.kind for row in rows):
        of_kind = [row for row in rows if row.kind == kind]
        yield [
            pairing.scene,
            f"{pairing.image[0]} against {pairing.reference[0]}",
            f"{pairing.image[1]} / {pairing.reference[1]}",
            kind,
            percent(float(np.median([row.size for row in of_kind]))),
            f"{sum(row.is_found for row in of_kind)} of {len(of_kind)}",
        ]


def main(arguments: list[str] | None = None) -> int:
    """`python -m bench.changes_found`; returns the exit code."""
    parser = parser_of("changes_found", __doc__)
    parser.add_argument("--pairs", type=at_least(1), default=100, metavar="N", help="pairs per row")
    parsed = parser.parse_args(arguments)
    return exit_code_of(lambda: _print(parsed.pairs))


def _print(pairs: int) -> None:
    context = open_context()
    print(f"{machine(context.renderer)}, {WIDTH} x {HEIGHT} pixels, alpha {ALPHA}")
    rows = [row for pairing in pairings() for row in experiment(context, pairing, pairs)]
    print("\n" + markdown(HEAD, rows), flush=True)


if __name__ == "__main__":
    sys.exit(main())
