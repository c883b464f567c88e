"""Tone curves and sRGB codes: known points, order and range, and the GLSL twin."""

import re
from typing import Any, get_args

import moderngl
import numpy as np
import pytest
from numpy.typing import NDArray

from glrt.gpu.glsl import read
from glrt.image.tonemap import BAND, CURVES, encode_srgb, expose, expose_and_encode
from glrt.settings import ToneMap
from tests.conftest import CallGlsl

GLSL = read("passes/tonemap.glsl")
every_tonemap = pytest.mark.parametrize("tonemap", get_args(ToneMap))

FRAGMENT = """
layout(location = 0) out vec4 pixel;
void main() { pixel = vec4(expose_and_encode(gl_FragCoord.xyz, 1.0, TONEMAP_AGX), 1.0); }
"""
TRIANGLE = "void main() { gl_Position = vec4(0.0, 0.0, 0.0, 1.0); }"


def codes_of(values: Any, tonemap: ToneMap, exposure: float = 0.0) -> NDArray[np.uint8]:
    """Codes of grey values, (n,)."""
    grey = np.repeat(np.asarray(values, np.float64)[:, None, None], 3, axis=2)
    return expose_and_encode(grey, exposure, tonemap)[:, 0, 0]


@pytest.fixture(scope="module")
def colors() -> NDArray[np.float32]:
    """Log-uniform colours from 1e-6 to 1e6."""
    exponents = np.random.default_rng(1).uniform(-6, 6, (1 << 16, 3))
    return np.power(10, exponents).astype(np.float32)


def test_srgb_goes_through_the_points_of_its_standard() -> None:
    encoded = 255 * encode_srgb(np.array([0.0, 0.0031308, 1.0]))
    np.testing.assert_allclose(encoded, [0.0, 10.31, 255.0], atol=5e-3)
    assert codes_of([0.0, 0.0031308, 0.18, 1.0], "none").tolist() == [0, 10, 118, 255]


def test_srgb_is_continuous_where_its_pieces_meet() -> None:
    below, above = encode_srgb(np.nextafter(0.0031308, [0.0, 1.0]))
    assert abs(above - below) < 1e-7


def test_every_code_survives_decoding_and_encoding() -> None:
    codes = np.arange(256)
    encoded = codes / 255
    linear = np.where(encoded <= 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4)
    assert codes_of(linear, "none").tolist() == codes.tolist()


def test_codes_are_rounded_to_nearest() -> None:
    slope = 12.92 * 255  # codes per radiance in the linear piece
    assert codes_of(np.array([4.49, 4.51]) / slope, "none").tolist() == [4, 5]


def test_exposure_counts_in_powers_of_two() -> None:
    image = np.random.default_rng(2).random((9, 5, 3))
    brighter = expose_and_encode(image, 3, "aces")
    assert np.array_equal(brighter, expose_and_encode(8 * image, 0, "aces"))
    assert not np.array_equal(brighter, expose_and_encode(image, 0, "aces"))


@every_tonemap
def test_greys_keep_their_order(tonemap: ToneMap) -> None:
    values = np.geomspace(1e-7, 1e9, 100_000)[:, None] * np.ones(3)
    mapped = CURVES[tonemap](values)
    drop = np.maximum.accumulate(mapped) - mapped
    assert drop.max() < 1e-4  # not 0: AgX's matrices are rounded, so its channels clip apart
    assert mapped[-1].min() > 0.99
    assert np.diff(codes_of(values[:, 0], tonemap).astype(int)).min() >= 0


@every_tonemap
def test_black_stays_black(tonemap: ToneMap) -> None:
    assert CURVES[tonemap](np.zeros((1, 3))).tolist() == [[0.0, 0.0, 0.0]]


@every_tonemap
def test_greys_stay_grey_to_a_code(tonemap: ToneMap) -> None:
    codes = expose_and_encode(np.geomspace(1e-4, 1e4, 999)[:, None, None] * np.ones(3), 0, tonemap)
    assert np.ptp(codes.astype(int), axis=2).max() <= 1


@every_tonemap
def test_every_colour_stays_in_range(tonemap: ToneMap) -> None:
    levels = [0.0, 1e-30, 1e-6, 0.5, 1.0, 1e6, 1e9]
    colors = np.stack(np.meshgrid(levels, levels, levels), axis=-1)
    mapped = CURVES[tonemap](colors)
    assert mapped.min() >= 0
    assert mapped.max() <= 1


@every_tonemap
def test_what_is_no_radiance_still_has_a_code(tonemap: ToneMap) -> None:
    odd = np.array([np.nan, -1.0, -np.inf, np.inf, np.finfo(np.float32).max])
    assert codes_of(odd, tonemap, exposure=50)[:3].tolist() == [0, 0, 0]
    assert codes_of(odd, tonemap, exposure=50)[3:].min() >= 254


def test_none_is_the_identity_up_to_one() -> None:
    values = np.array([[0.0, 0.25, 1.0], [1.5, 0.5, 100.0]])
    assert CURVES["none"](values).tolist() == [[0.0, 0.25, 1.0], [1.0, 0.5, 1.0]]


def test_neutral_only_subtracts_its_offset_below_the_shoulder() -> None:
    colors = np.random.default_rng(3).uniform(0.08, 0.8, (1000, 3))
    np.testing.assert_allclose(CURVES["neutral"](colors), colors - 0.04, atol=1e-12)


def test_neutral_is_the_identity_for_colours_with_an_empty_channel() -> None:
    color = np.array([[0.0, 0.3, 0.7]])
    np.testing.assert_allclose(CURVES["neutral"](color), color, atol=1e-12)


def test_neutral_follows_its_specification_above_the_shoulder() -> None:
    # c = (2, 1, 0.04): f = 0.03, p = 1.97, p_n = 1 - 0.24^2 / 1.45, g = 0.868463
    expected = [[0.960276, 0.536943, 0.130545]]
    np.testing.assert_allclose(CURVES["neutral"](np.array([[2.0, 1.0, 0.04]])), expected, rtol=1e-5)


def test_neutral_has_no_kink_at_its_shoulder() -> None:
    values = 0.8 + np.array([-2e-5, -1e-5, 1e-5, 2e-5])[:, None] * np.ones(3)
    low, _, high = np.diff(CURVES["neutral"](values)[:, 0]) / [1e-5, 2e-5, 1e-5]
    assert low == pytest.approx(high, rel=1e-3)


def test_aces_shows_middle_grey_where_its_authors_put_it() -> None:
    v = 0.18
    fitted = (v * (v + 0.0245786) - 0.000090537) / (v * (0.983729 * v + 0.4329510) + 0.238081)
    assert CURVES["aces"](np.full((1, 3), 0.18)) == pytest.approx(fitted, rel=2e-4)


def test_agx_shows_middle_grey_at_half_the_signal_and_saturates_6_5_stops_above() -> None:
    middle, bright, brighter = CURVES["agx"](np.array([[0.18], [16.29], [1000.0]]) * np.ones(3))
    assert middle == pytest.approx(0.5**2.2, rel=0.02)
    assert bright == pytest.approx(brighter, rel=1e-4)


@pytest.mark.parametrize("curve", ["aces", "agx", "neutral"])
def test_very_bright_colours_fade_to_white(curve: ToneMap) -> None:
    red, dim = expose_and_encode(np.array([[[1e6, 1e2, 1e2], [0.5, 0.05, 0.05]]]), 0, curve)[0]
    assert red.min() > 250
    assert np.ptp(dim.astype(int)) > 60


def test_tall_images_are_encoded_row_by_row_alike() -> None:
    image = np.random.default_rng(4).random((2 * BAND + 1, 3, 3), np.float32)
    whole = expose_and_encode(image, 0, "agx")
    rows = [expose_and_encode(row[None], 0, "agx")[0] for row in image]
    assert np.array_equal(whole, rows)


def test_exposing_leaves_the_radiance_alone() -> None:
    image = np.full((2, 2, 3), -1.0, np.float32)
    assert expose(image, 1).max() == 0
    assert image.max() == -1


def test_glsl_and_python_number_the_curves_alike() -> None:
    names = re.findall(r"const int TONEMAP_(\w+) = (\d);", GLSL)
    assert [(name.lower(), int(number)) for name, number in names] == [
        (name, number) for number, name in enumerate(get_args(ToneMap))
    ]
    assert list(CURVES) == list(get_args(ToneMap))


def glsl_encoded(
    call_glsl: CallGlsl, colors: NDArray[np.float32], tonemap: ToneMap, exposure: float
) -> NDArray[np.float32]:
    """Colours (n, 3), encoded by the GLSL twin: 0..1 before rounding."""
    return call_glsl(
        "expose_and_encode(color, exposure_ev, tonemap)",
        returns="vec3",
        functions=GLSL,
        color=colors,
        exposure_ev=exposure,
        tonemap=list(CURVES).index(tonemap),
    )


@pytest.mark.parametrize("exposure", [0.0, -2.5])
@every_tonemap
def test_the_glsl_twin_agrees_to_a_code(
    call_glsl: CallGlsl, colors: NDArray[np.float32], tonemap: ToneMap, exposure: float
) -> None:
    encoded = glsl_encoded(call_glsl, colors, tonemap, exposure)
    assert encoded.min() >= 0
    assert encoded.max() <= 1
    expected = expose_and_encode(colors[:, None], exposure, tonemap)[:, 0].astype(int)
    difference = np.abs(np.rint(255 * encoded) - expected)
    assert difference.max() <= 1
    assert difference.mean() < 1e-3


@every_tonemap
def test_the_glsl_twin_survives_infinity_and_negative_values(
    call_glsl: CallGlsl, tonemap: ToneMap
) -> None:
    odd = np.repeat(np.array([[-1.0], [np.inf], [3e38]], np.float32), 3, axis=1)
    encoded = glsl_encoded(call_glsl, odd, tonemap, 50.0)
    assert encoded[0].max() == 0
    assert encoded[1:].min() > 0.99


def test_the_glsl_twin_compiles_for_opengl_4_1(ctx: moderngl.Context) -> None:
    program = ctx.program(
        "#version 410\n" + TRIANGLE, fragment_shader="#version 410\n" + GLSL + FRAGMENT
    )
    program.release()
