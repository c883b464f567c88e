"""A clear sky for a direction of the sun, and the irradiance of that sun.

L. Hosek, A. Wilkie, "An Analytic Model for Full Spectral Sky-Dome Radiance" (ACM Transactions on
Graphics 31(4), 2012), and "Adding a Solar-Radiance Function to the Hosek-Wilkie Skylight Model"
(IEEE Computer Graphics and Applications 33(3), 2013). Radiance is in W / (m^2 sr nm), irradiance in
W / (m^2 nm), means weighted by the eye's sensitivity, in linear sRGB: 1 stands for 72,983 cd/m^2
or lux. Where a saturated colour lies outside of sRGB, its negative channel is 0.
"""

import math
from functools import cache, lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from glrt.scene.values import Fraction, Intensity, Number, Radiance, Value
from glrt.settings import Cost, Editable

Array = NDArray[np.float64]

ROWS = 512  # rows of the image of the sky, which has twice as many columns
_SENSITIVITY = 106.856980  # integral of the eye's sensitivity, nm
_DEGREE = 5  # degree of the Bezier curve along the sun's elevation


class ClearSky(Value):
    """The sky of Hosek and Wilkie for the direction of `[sun]`, above a ground that it lights.

    Radiance is in W/(m² sr nm), weighted by the eye's sensitivity; `scale` multiplies it.
    """

    turbidity: Annotated[float, Field(ge=1, le=10), Editable(Cost.RESTART, "", (1, 10))] = Field(
        3.0, description="haze: 2 for an arctic sky, 3 for a clear one, 6 for a warm and moist day"
    )
    ground: Annotated[Fraction, Editable(Cost.RESTART)] = Field(
        0.3,
        description="albedo of the ground, which is below the horizon, matte, and lit by the model",
    )
    scale: Annotated[Intensity, Editable(Cost.RECOMPILE, "", (0, 20))] = Field(
        1.0, description="factor of the radiance, and of the sun's where the model gives it"
    )

    if TYPE_CHECKING:

        def __init__(
            self, *, turbidity: Number = 3.0, ground: Number = 0.3, scale: Number = 1.0
        ) -> None: ...

    def sun(self, towards: Array) -> Radiance:
        """Return the irradiance of a sun at `towards`, times `scale`; black below the horizon."""
        if towards[1] < 0:
            return (0.0, 0.0, 0.0)
        red, green, blue = _sun_irradiance(self.turbidity, _elevation(towards)) * self.scale
        return (float(red), float(green), float(blue))

    def radiance(self, towards: Array, directions: Array) -> Array:
        """Return the sky's radiance, (N, 3), at scale 1 and without the sun.

        It comes from unit directions, (N, 3), at and above the horizon; `towards`, (3,), is the
        sun's.
        """
        return self._radiance(towards, directions[:, 1], directions @ towards)

    def _radiance(self, towards: Array, height: Array, cos_gamma: Array) -> Array:
        """Return radiance by sine of elevation and cosine of the angle to the sun, broadcast."""
        shape, factor = _distribution(self.turbidity, self.ground, _elevation(towards))
        height, cos_gamma = np.clip(height, 0, 1)[..., None], np.clip(cos_gamma, -1, 1)[..., None]
        a, b, c, d, e, f, g, i, h = shape
        width = 1 + h * h - 2 * h * cos_gamma
        haze = (1 + cos_gamma**2) / (width * np.sqrt(width))
        along = (1 + a * np.exp(b / (height + 0.01))) * factor
        glow = d * np.exp(e * np.arccos(cos_gamma)) + f * cos_gamma**2 + g * haze
        sky: Array = np.maximum(along * (c + i * np.sqrt(height) + glow), 0)
        return sky


@lru_cache(maxsize=4)
def sky_pixels(
    turbidity: float, ground: float, towards: tuple[float, float, float]
) -> NDArray[np.float32]:
    """Return the sky of all directions at scale 1, as a scene's image has it: (512, 1024, 3)."""
    sky, sun = ClearSky(turbidity=turbidity, ground=ground), np.array(towards)
    angle = np.pi * (np.arange(ROWS // 2) + 0.5)[:, None] / ROWS  # from the zenith
    azimuth = np.pi * (np.arange(2 * ROWS) + 0.5) / ROWS - np.pi  # from -z towards +x
    flat, high = np.sin(angle), np.cos(angle)
    x, y, z = towards
    cos_gamma = flat * (x * np.sin(azimuth) - z * np.cos(azimuth)) + y * high
    above = sky._radiance(sun, high, cos_gamma)
    patch = (np.pi / ROWS) * 2 * math.sin(np.pi / (2 * ROWS)) * flat  # solid angles
    received = np.einsum("ruc,ro->c", above, patch * high) + np.array(sky.sun(sun)) * towards[1]
    below = np.broadcast_to(ground * received / np.pi, above.shape)
    found = np.concatenate([above, below]).astype(np.float32)
    found.flags.writeable = False
    return found


def _elevation(towards: Array) -> float:
    return math.asin(min(max(float(towards[1]), 0.0), 1.0))


@cache
def _coefficients() -> dict[str, Array]:
    with np.load(Path(__file__).with_name("clear_sky.npz")) as file:
        return {name: file[name] for name in file.files}


def _of_turbidity(table: Array, turbidity: float) -> Array:
    """Interpolate a table between two of its ten turbidities."""
    low = min(int(turbidity), 9)
    share = turbidity - low
    found: Array = table[low - 1] * (1 - share) + table[low] * share
    return found


def _distribution(turbidity: float, ground: float, elevation: float) -> tuple[Array, Array]:
    """Return the nine coefficients of each channel, (9, 3), and the factor of their sum, (3,)."""
    along = (elevation / (math.pi / 2)) ** (1 / 3)
    powers = [along**n * (1 - along) ** (_DEGREE - n) for n in range(_DEGREE + 1)]
    bezier = np.array([math.comb(_DEGREE, n) * power for n, power in enumerate(powers)])

    def between(table: Array) -> Array:
        dark, bright = _of_turbidity(table, turbidity)
        found: Array = np.tensordot(bezier, dark * (1 - ground) + bright * ground, axes=1)
        return found

    coefficients = _coefficients()
    shape, factor = between(coefficients["shape"]), between(coefficients["radiance"])
    return shape.T, factor / _SENSITIVITY


def _sun_irradiance(turbidity: float, elevation: float) -> Array:
    """Return the irradiance of the sun, (3,): a cubic in each of 45 pieces of the elevation.

    The pieces end at cubes of equal steps.
    """
    pieces = _of_turbidity(_coefficients()["sun"], turbidity)
    count = len(pieces)
    piece = min(int((elevation / (math.pi / 2)) ** (1 / 3) * count), count - 1)
    above = elevation - (math.pi / 2) * (piece / count) ** 3
    found: Array = np.maximum(pieces[piece] @ above ** np.arange(4), 0)
    return found
