"""Glasses that overlap by priority: how many of them the kernel can count."""

from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from glrt.core.text import quoted
from glrt.scene.materials.dielectric import Dielectric
from glrt.scene.materials.kinds import Material
from glrt.scene.schema.validation import Place
from glrt.scene.shapes.kinds import Shape

MOST_GLASSES = 6  # glasses with a priority in a scene: the kernel counts them in one word
BITS = 5  # BITS_OF_COUNT of the kernel
MOST_NESTED = (1 << BITS) - 1  # objects of one such glass that may overlap
_COMPARED = 4096  # objects of one glass that are compared


def nesting_problems(
    materials: Mapping[str, Material], shapes: Sequence[Shape]
) -> Iterator[tuple[Place, str]]:
    """Yield what does not fit: too many glasses with a priority, or too many that overlap."""
    used = dict.fromkeys(shape.material for shape in shapes)
    ranked = [name for name in used if _priority(materials.get(name)) is not None]
    if len(ranked) > MOST_GLASSES:
        yield ("materials", ranked[MOST_GLASSES], "priority"), _TOO_MANY.format(len(ranked))
    for name in ranked:
        same = [shape for shape in shapes if shape.material == name]
        deepest = _neighbours(same) if len(same) > MOST_NESTED else 0
        if deepest >= MOST_NESTED:
            yield (
                ("materials", name, "priority"),
                f"up to {deepest + 1} objects of {quoted(name)} may overlap, and {MOST_NESTED} "
                "can; move them apart, or give some of them another material",
            )


def _priority(material: Material | None) -> int | None:
    return material.priority if isinstance(material, Dielectric) else None


_TOO_MANY = (
    "{} materials with a priority are used, and "
    f"{MOST_GLASSES} can be; leave the priority out where glass does not overlap"
)


def _neighbours(shapes: Sequence[Shape]) -> int:
    """Return the largest number of shapes whose balls meet the ball of one shape."""
    middle = np.array([shape.middle for shape in shapes[:_COMPARED]])
    reach = np.array([shape.reach for shape in shapes[:_COMPARED]])
    apart = (np.linalg.norm(middle - middle[k], axis=1) for k in range(len(middle)))
    return max(int(np.count_nonzero(far < reach + reach[k])) - 1 for k, far in enumerate(apart))
