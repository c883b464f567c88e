"""Metals by their complex index of refraction, n + i k of red, green and blue.

tools/metals.py computes the presets from measured spectra; docs/explanation/metals.md names them.
"""

from typing import Literal, NamedTuple

from glrt.scene.values import Color

PresetName = Literal[
    "aluminium", "brass", "chromium", "copper", "gold", "iron", "silver", "titanium"
]
Channels = tuple[float, float, float]


class Conductor(NamedTuple):
    """The complex index of refraction of a metal against air, in each channel."""

    ior: Channels  # n
    k: Channels  # extinction coefficient

    @property
    def head_on(self) -> Color:
        """Reflectance at normal incidence, in each channel."""
        red, green, blue = (
            ((n - 1) ** 2 + k**2) / ((n + 1) ** 2 + k**2)
            for n, k in zip(self.ior, self.k, strict=True)
        )
        return red, green, blue


PRESETS: dict[str, Conductor] = {  # by each PresetName
    "aluminium": Conductor((1.017, 0.764, 0.496), (6.294, 5.768, 4.841)),
    "brass": Conductor((0.491, 0.562, 1.074), (4.063, 2.806, 1.739)),
    "chromium": Conductor((3.13, 3.053, 2.357), (3.284, 3.328, 3.139)),
    "copper": Conductor((0.491, 1.018, 1.247), (4.447, 2.602, 2.301)),
    "gold": Conductor((0.29, 0.544, 1.355), (10.697, 2.41, 1.705)),
    "iron": Conductor((2.89, 2.89, 2.576), (3.063, 2.937, 2.748)),
    "silver": Conductor((0.054, 0.054, 0.044), (4.294, 3.52, 2.597)),
    "titanium": Conductor((2.636, 2.499, 2.265), (3.766, 3.399, 3.018)),
}
