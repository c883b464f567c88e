"""Tone curves: radiance to 8-bit sRGB, as `shaders_glsl/passes/tonemap.glsl` does.

exposure -> tone curve -> sRGB encoding -> rounding. Colours are linear sRGB (Rec. 709 primaries);
the last axis holds R, G, B.
"""

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike, NDArray

from glrt.core.errors import UsageError
from glrt.settings import ToneMap

Colors = NDArray[np.float64]

LIMIT = 1e9  # every curve is flat to 8 bits long before; float32 squares are finite up to here
BAND = 64  # rows in work at a time: float64 copies stay small compared to the image


def expose_and_encode(radiance: ArrayLike, exposure: float, tonemap: ToneMap) -> NDArray[np.uint8]:
    """Radiance (H, W, 3) times 2^exposure, through a tone curve, as sRGB codes (H, W, 3).

    Negative values and NaN count as 0. Codes are rounded to nearest. Raises `UsageError` for a
    tone curve that does not exist.
    """
    if tonemap not in CURVES:
        raise UsageError(f"Unknown tone curve '{tonemap}'. Choose one of {', '.join(CURVES)}.")
    image = np.asarray(radiance)
    codes = np.empty(image.shape, np.uint8)
    for row in range(0, len(image), BAND):
        band = slice(row, row + BAND)
        color = expose(image[band], exposure)
        codes[band] = np.rint(255 * encode_srgb(CURVES[tonemap](color)))
    return codes


def expose(radiance: ArrayLike, exposure: float) -> Colors:
    """Radiance times 2^exposure, limited to 0..1e9; NaN becomes 0."""
    exposed = np.asarray(radiance, np.float64) * 2.0**exposure
    limited: Colors = np.minimum(np.fmax(exposed, 0), LIMIT)
    return limited


def encode_srgb(linear: Colors) -> Colors:
    """The sRGB transfer function of IEC 61966-2-1, piecewise; 0..1 to 0..1."""
    curved = 1.055 * np.power(linear, 1 / 2.4) - 0.055
    return np.where(linear <= 0.0031308, 12.92 * linear, curved)


def tone_none(color: Colors) -> Colors:
    """Clamp to 0..1."""
    return _unit(color)


def _unit(values: Colors) -> Colors:
    return np.clip(values, 0.0, 1.0)


_ACES_INPUT = np.array(  # linear sRGB -> XYZ -> D60 -> AP1 -> RRT saturation
    [[0.59719, 0.35458, 0.04823], [0.07600, 0.90834, 0.01566], [0.02840, 0.13383, 0.83777]]
)
_ACES_OUTPUT = np.array(  # ODT saturation -> XYZ -> D65 -> linear sRGB
    [[1.60475, -0.53108, -0.07367], [-0.10208, 1.10813, -0.00605], [-0.00327, -0.07276, 1.07602]]
)


def tone_aces(color: Colors) -> Colors:
    """ACES RRT + sRGB ODT, as fitted by Stephen Hill (ACES.hlsl in MJP's BakingLab)."""
    v = color @ _ACES_INPUT.T
    fitted = (v * (v + 0.0245786) - 0.000090537) / (v * (0.983729 * v + 0.4329510) + 0.238081)
    return _unit(fitted @ _ACES_OUTPUT.T)


_AGX_INSET = np.array(
    [
        [0.842479062253094, 0.0784335999999992, 0.0792237451477643],
        [0.0423282422610123, 0.878468636469772, 0.0791661274605434],
        [0.0423756549057051, 0.0784336, 0.879142973793104],
    ]
)
_AGX_OUTSET = np.array(
    [
        [1.19687900512017, -0.0980208811401368, -0.0990297440797205],
        [-0.0528968517574562, 1.15190312990417, -0.0989611768448433],
        [-0.0529716355144438, -0.0980434501171241, 1.15107367264116],
    ]
)
_AGX_LOG2_MIN, _AGX_LOG2_MAX = -12.47393, 4.026069  # 10 stops below and 6.5 above 0.18
_AGX_POLYNOMIAL = (15.5, -40.14, 31.96, -6.868, 0.4298, 0.1191, -0.00232)  # falling powers


def tone_agx(color: Colors) -> Colors:
    """AgX by Troy Sobotka, base look, as fitted in Benjamin Wrensch's "Minimal AgX Implementation".

    The fit of degree 6, which is monotone (the one of degree 7 is not). Its result is meant for a
    display with exponent 2.2, so it is clamped to 0..1 and raised to 2.2: linear again.
    """
    log2 = np.log2(np.maximum(color @ _AGX_INSET.T, 2.0**_AGX_LOG2_MIN))
    x = np.minimum((log2 - _AGX_LOG2_MIN) / (_AGX_LOG2_MAX - _AGX_LOG2_MIN), 1)
    signal = _unit(np.polyval(_AGX_POLYNOMIAL, x) @ _AGX_OUTSET.T)
    return signal**2.2


_NEUTRAL_F90 = 0.04  # Fresnel reflection of glass at normal incidence
_NEUTRAL_SHOULDER = 0.8 - _NEUTRAL_F90
_NEUTRAL_DESATURATION = 0.15


def tone_neutral(color: Colors) -> Colors:
    """Khronos PBR Neutral (PBR_Neutral/README.md in KhronosGroup/ToneMapping).

    Subtracts min(R, G, B) - min(R, G, B)^2 / 0.16, at most 0.04; is the identity otherwise, up to
    a peak of 0.76; above, compresses the peak and fades to white.
    """
    darkest = np.minimum(color.min(axis=-1, keepdims=True), 2 * _NEUTRAL_F90)
    color = color - (darkest - darkest**2 / (4 * _NEUTRAL_F90))
    peak = np.maximum(color.max(axis=-1, keepdims=True), _NEUTRAL_SHOULDER)
    room = 1 - _NEUTRAL_SHOULDER
    new_peak = 1 - room**2 / (peak - _NEUTRAL_SHOULDER + room)
    kept = 1 / (_NEUTRAL_DESATURATION * (peak - new_peak) + 1)
    faded: Colors = color * (new_peak / peak) * kept + new_peak * (1 - kept)
    return faded


CURVES: dict[ToneMap, Callable[[Colors], Colors]] = {
    "none": tone_none,
    "aces": tone_aces,
    "agx": tone_agx,
    "neutral": tone_neutral,
}
