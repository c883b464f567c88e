"""Write glrt/scene/lights/clear_sky.npz, the coefficients of the clear sky, from the model.

They are read from the copy that comes with Mitsuba 3, a package of the tests. Run it as
`python tools/clear_sky.py`; a test holds that it changes nothing.
"""

import importlib.util
import struct
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

TARGET = Path(__file__).parents[1] / "glrt/scene/lights/clear_sky.npz"
WAVELENGTHS = np.arange(320.0, 721.0, 40.0)  # of the solar radiance, nm
SUN_OF_THE_MODEL = np.radians(0.2679)  # half of its angle
_MAGIC, _DOUBLE = b"tensor_file\0", 11


def coefficients() -> dict[str, Array]:
    """The arrays of the file.

    shape: (10 turbidities, 2 albedos, 6 control points, 3 channels, 9) of the sky's distribution;
    radiance: (10, 2, 6, 3), its factor; sun: (10 turbidities, 45 pieces, 3 channels, 4) of the
    sun's irradiance as a cubic of the angle above the start of its piece. Channels are linear sRGB,
    the sky's times the integral of the eye's sensitivity, 106.86 nm.
    """
    tensors = _tensors(_source())
    return {
        "shape": tensors["sky_params_rgb"],
        "radiance": tensors["sky_rad_rgb"],
        "sun": _sun(tensors["sun_rad_spec"], tensors["sun_ld_spec"]),
    }


def _sun(spectral: Array, darkening: Array) -> Array:
    """Irradiance in linear sRGB from radiance by wavelength, (10, 45, 11, 4).

    Towards the rim the sun is darker by a polynomial of the cosine at its surface; the mean over
    the disc of that cosine to the power j is 2 / (j + 2).
    """
    mean = (darkening * 2 / (np.arange(darkening.shape[1]) + 2)).sum(axis=1)
    solid_angle = np.pi * np.sin(SUN_OF_THE_MODEL) ** 2
    weights = _rgb_of_wavelengths() * mean * solid_angle
    found: Array = np.einsum("cw,tpwk->tpck", weights, spectral)
    return found


def _rgb_of_wavelengths() -> Array:
    """(3, 11): linear sRGB of a spectrum that is linear between its wavelengths.

    The eye's sensitivities are those of C. Wyman, P.-P. Sloan, P. Shirley, "Simple analytic
    approximations to the CIE XYZ color matching functions" (JCGT 2, 2013), multi-lobe.
    """
    fine = np.arange(WAVELENGTHS[0], WAVELENGTHS[-1] + 1)

    def lobe(height: float, middle: float, below: float, above: float) -> Array:
        width = np.where(fine < middle, below, above)
        found: Array = height * np.exp(-0.5 * ((fine - middle) * width) ** 2)
        return found

    x = lobe(0.362, 442.0, 0.0624, 0.0374) + lobe(1.056, 599.8, 0.0264, 0.0323)
    x = x + lobe(-0.065, 501.1, 0.0490, 0.0382)
    y = lobe(0.821, 568.8, 0.0213, 0.0247) + lobe(0.286, 530.9, 0.0613, 0.0322)
    z = lobe(1.217, 437.0, 0.0845, 0.0278) + lobe(0.681, 459.0, 0.0385, 0.0725)
    hats = np.array([np.interp(fine, WAVELENGTHS, unit) for unit in np.eye(len(WAVELENGTHS))])
    xyz = np.array([x, y, z]) @ hats.T / y.sum()
    found: Array = _SRGB_OF_XYZ @ xyz
    return found


_SRGB_OF_XYZ = np.array(  # IEC 61966-2-1
    [
        [3.2404542, -1.5371385, -0.4985314],
        [-0.9692660, 1.8760108, 0.0415560],
        [0.0556434, -0.2040259, 1.0572252],
    ]
)


def _source() -> bytes:
    found = importlib.util.find_spec("mitsuba")
    assert found is not None
    assert found.origin is not None
    return (Path(found.origin).parent / "data" / "sunsky" / "sunsky_datasets.bin").read_bytes()


def _tensors(content: bytes) -> dict[str, Array]:
    """The float64 arrays of a tensor file of Mitsuba by name."""
    assert content.startswith(_MAGIC)
    place = len(_MAGIC) + 2  # the version
    (count,) = struct.unpack_from("<I", content, place)
    place += 4
    found = {}
    for _ in range(count):
        (length,) = struct.unpack_from("<H", content, place)
        name = content[place + 2 : place + 2 + length].decode()
        place += 2 + length
        dimensions, kind, start = struct.unpack_from("<HBQ", content, place)
        assert kind == _DOUBLE
        shape = struct.unpack_from(f"<{dimensions}Q", content, place + 11)
        place += 11 + 8 * dimensions
        values = np.frombuffer(content, np.float64, int(np.prod(shape)), start)
        found[name] = values.reshape(shape)
    return found


if __name__ == "__main__":
    np.savez_compressed(TARGET, **coefficients())  # type: ignore[arg-type]
