"""Phase functions, flights and their weights: against float64 and closed forms."""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tests.conftest import CallGlsl
from tests.shaders.test_sampling import DRAWS, GRIDS, RNG, Floats, cells_of
from tests.support.alarms import assert_fits
from tests.support.builders import lamp, scene_of, sphere
from tests.support.numerics import BELOW_ONE

TURNS = [-0.99, -0.5, 0.0, 1e-4, 0.6, 0.99]
UP = "vec3(0.0, 0.0, 1.0)"


def one(value: float) -> Floats:
    """A number for all lanes."""
    return np.array([value])


def below(g: float, cosine: Floats) -> Floats:
    """The chance of a turn whose cosine is below a limit."""
    if g == 0:
        return (cosine + 1) / 2
    return ((1 - g * g) / np.sqrt(1 + g * g - 2 * g * cosine) - (1 - g)) / (2 * g)


@pytest.mark.parametrize("grid", GRIDS, ids=str)
@pytest.mark.parametrize("g", [-0.8, 0.0, 0.5])
def test_light_turns_by_the_density(call_glsl: CallGlsl, g: float, grid: tuple[int, int]) -> None:
    rows, columns = grid
    share = np.diff(below(g, np.linspace(-1, 1, rows + 1))) / columns
    drawn = call_glsl(
        f"sample_phase(g, {UP}, next_2d(rng))", "vec3", setup=RNG, n=np.arange(DRAWS), g=one(g)
    )
    assert_fits(cells_of(drawn, *grid, lowest=-1.0), DRAWS * np.repeat(share, columns))


@pytest.mark.parametrize("g", TURNS)
def test_a_turn_is_the_inverse_of_its_distribution(call_glsl: CallGlsl, g: float) -> None:
    """Its mean is g, that of its second Legendre polynomial g^2 (Henyey and Greenstein 1941)."""
    u = (np.arange(200_000) + 0.5) / 200_000
    cosine = call_glsl("sample_turn(g, u)", u=u.astype(np.float32), g=one(g)).astype(np.float64)
    if abs(g) > 0.01:
        exact = (1 + g * g - ((1 - g * g) / (1 - g + 2 * g * u)) ** 2) / (2 * g)
        assert_allclose(cosine, exact, atol=4e-3 if abs(g) > 0.9 else 2e-6)
    assert cosine.mean() == pytest.approx(g, abs=2e-5)
    assert (1.5 * cosine**2 - 0.5).mean() == pytest.approx(g * g, abs=5e-5)


@pytest.mark.parametrize("g", TURNS)
def test_the_density_of_a_turn_keeps_its_digits(call_glsl: CallGlsl, g: float) -> None:
    angle = np.concatenate([np.linspace(0, np.pi, 1001), 10.0 ** np.linspace(-5, -1, 100)])
    to = np.stack([np.sin(angle), np.zeros_like(angle), np.cos(angle)], axis=1).astype(np.float32)
    found = call_glsl(f"eval_phase(g, {UP}, to)", to=to, g=one(g))
    unit = to.astype(np.float64) / np.linalg.norm(to.astype(np.float64), axis=1, keepdims=True)
    spread = 1 + g * g - 2 * g * unit[:, 2]
    assert_allclose(found, (1 - g * g) / (4 * np.pi * spread**1.5), rtol=3e-4)


def test_the_depth_of_a_flight_is_a_logarithm(call_glsl: CallGlsl) -> None:
    u = np.concatenate([np.linspace(0, 1, 100_001)[:-1], 10.0 ** np.linspace(-12, -1, 10_000)])
    u = np.append(u, BELOW_ONE).astype(np.float32)
    found = call_glsl("depth_of(u)", u=u)
    left = (np.float32(1) - u).astype(np.float64)  # what is left of u after rounding
    assert_allclose(found, -np.log(left), rtol=3e-7, atol=1e-12)


def test_light_on_a_way_is_the_integral_of_what_is_left(call_glsl: CallGlsl) -> None:
    x = (10.0 ** np.linspace(-9, 3, 20_000)).astype(np.float32)
    found = call_glsl("integral_of_decay(x, 1.5)", x=x)
    assert_allclose(found, -np.expm1(-1.5 * x.astype(np.float64)) / x, rtol=1e-6)
    ends = call_glsl("integral_of_decay(x, d)", x=np.array([0.0, 2.0]), d=np.array([3.0, 1e30]))
    assert ends.tolist() == [3.0, 0.5]


FLIGHT = """
    Flight flight = start_flight(NO_MEDIUM);
    begin_flight(flight, throughput, rng);
    Medium medium = medium_at(0);  // a row of zeros
    medium.scattering = scattering;
    medium.extinction = extinction;
    float d = flight.depth / extinction[flight.channel];
    bool collides = d < 0.7;
    flight.left *= share_left(extinction, min(d, 0.7));
    vec3 weight = collides ? weight_of_collision(flight, medium) : weight_of_flight(flight);"""
THROUGHPUT = np.array([0.9, 0.3, 0.05])


def flights(call_glsl: CallGlsl, scattering: list[float], extinction: list[float]) -> Floats:
    """Weights of flights over 0.7, and 1 where they collide, (DRAWS, 4)."""
    given = {"throughput": THROUGHPUT, "scattering": scattering, "extinction": extinction}
    rows = {name: np.tile(np.array(it), (DRAWS, 1)) for name, it in given.items()}
    found = call_glsl("vec4(weight, collides ? 1.0 : 0.0)", "vec4", setup=RNG + FLIGHT, **rows)
    return found.astype(np.float64)


def test_flights_collide_as_often_as_beer_says_in_each_channel(call_glsl: CallGlsl) -> None:
    """The mean of the throughput that passes a slab is Beer's; no weight exceeds the sum."""
    mu = np.array([0.2, 2.0, 20.0])
    found = flights(call_glsl, mu.tolist(), mu.tolist())
    left = found[:, :3] * THROUGHPUT
    assert left.max() <= THROUGHPUT.sum() * (1 + 1e-5)
    is_met = found[:, 3] > 0
    for truth, where in ((np.exp(-0.7 * mu), ~is_met), (-np.expm1(-0.7 * mu), is_met)):
        values = left * where[:, None]
        far = (values.mean(axis=0) - THROUGHPUT * truth) / (values.std(axis=0) / DRAWS**0.5)
        assert (np.abs(far) < 5).all(), far


def test_gray_flights_have_no_noise_in_their_weight(call_glsl: CallGlsl) -> None:
    found = flights(call_glsl, [1.5] * 3, [2.0] * 3)
    wanted = np.where(found[:, 3:] > 0, 0.75, 1.0)
    assert_allclose(found[:, :3], np.broadcast_to(wanted, (DRAWS, 3)), rtol=1e-6)


LAMPS = scene_of(
    [sphere([0.5, 1.0, -2.0], 0.3, "lamp")],
    {"lamp": lamp(1.0)},
    media={"fog": {"scattering": [1.0] * 3}},
    medium="fog",
)


@pytest.mark.parametrize("end", [0.5, 4.0, 3.402823466e38])
def test_places_along_a_segment_follow_their_density(call_glsl: CallGlsl, end: float) -> None:
    """Its integral up to a place is the number that the place is drawn by."""
    u = ((np.arange(20_000) + 0.5) / 20_000).astype(np.float32)
    setup = """
        Approach at = Approach(vec3(0.0), vec3(0.0, 0.0, -1.0), end, 0.0, 1.0, 1.0);
        Sight sight = sight_of(at, cluster_at(0));
        float way = sample_equiangular(sight, u);"""
    found = call_glsl(
        "vec2(way, pdf_equiangular(sight, way))",
        "vec2",
        setup=setup,
        scene=LAMPS,
        u=u,
        end=one(end),
    )
    way, pdf = found.astype(np.float64).T
    height, foot = math.sqrt(0.5**2 + 1), 2.0
    first, last = (math.atan2(x - foot, height) for x in (0.0, end))
    assert_allclose(pdf, height / ((last - first) * (height**2 + (way - foot) ** 2)), rtol=2e-6)
    assert_allclose(way, foot + height * np.tan(first + u * (last - first)), rtol=5e-3, atol=1e-6)
    assert (np.diff(way) > 0).all()
    assert way.max() <= end


def test_six_flights_go_as_far_as_their_turns_let_them(call_glsl: CallGlsl) -> None:
    """The mean square of the way is 2 (n / (1 - g) - g (1 - g^n) / (1 - g)^2) / m^2."""
    n, g, m = 6, 0.6, 2.0
    setup = """
        vec3 place = vec3(0.0);
        vec3 towards = vec3(0.0, 0.0, 1.0);
        Flight flight = start_flight(NO_MEDIUM);
        for (int k = 0; k < steps; ++k) {
            begin_flight(flight, vec3(1.0), rng);
            place += flight.depth / m * towards;
            towards = sample_phase(g, towards, next_2d(rng));
        }"""
    given = {"steps": np.full(DRAWS, n, np.int32), "g": one(g), "m": one(m)}
    found = call_glsl("dot(place, place)", setup=RNG + setup, **given).astype(np.float64)
    truth = 2 / m**2 * (n / (1 - g) - g * (1 - g**n) / (1 - g) ** 2)
    assert truth == pytest.approx(22.850 / 4, abs=1e-3)
    assert abs(found.mean() - truth) < 4.5 * found.std() / DRAWS**0.5
