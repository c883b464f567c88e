"""Arithmetic of nodes with numbers and colors."""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from glrt.scene.model_files.networks.nodes import Numbers

Array = NDArray[np.float64]

_LUMINANCE = np.array([0.2126, 0.7152, 0.0722])  # of Rec. 709

TWO: dict[str, Callable[[Array, Array], Array]] = {
    "add": lambda a, b: a + b,
    "subtract": lambda a, b: a - b,
    "multiply": lambda a, b: a * b,
    "divide": lambda a, b: a / b,
    "power": lambda a, b: a**b,
    "modulo": lambda a, b: a - b * np.floor(a / b),
    "min": np.minimum,
    "max": np.maximum,
}
ONE: dict[str, Callable[[Array], Array]] = {
    "absval": np.abs,
    "sqrt": np.sqrt,
    "exp": np.exp,
    "floor": np.floor,
    "ceil": np.ceil,
    "sin": np.sin,
    "cos": np.cos,
    "luminance": lambda a: np.full(3, a[:3] @ _LUMINANCE) if len(a) > 2 else a,
}


def of_two(category: str, first: Numbers, second: Numbers) -> Numbers:
    """Return what two values give; of a number and a color, the number is repeated."""
    if len(first) > 1 and len(second) > 1:  # types that do not fit: the numbers that both have
        count = min(len(first), len(second))
        first, second = first[:count], second[:count]
    with np.errstate(all="ignore"):
        found = TWO[category](np.array(first, np.float64), np.array(second, np.float64))
    return tuple(map(float, found))


def of_one(category: str, given: Numbers) -> Numbers:
    """Return what a value gives."""
    with np.errstate(all="ignore"):
        return tuple(map(float, ONE[category](np.array(given, np.float64))))


def between(first: Numbers, second: Numbers, share: float) -> Numbers:
    """Return the mean of two values, by the share of the second."""
    way = of_two("subtract", second, first)
    return of_two("add", first, of_two("multiply", way, (share,)))
