"""Links through one sphere, against rays that are traced here, one refraction after another."""

from typing import Any, NamedTuple

import numpy as np
import pytest
from numpy.testing import assert_allclose

from glrt.gpu.glsl import read
from glrt.scene.scene import Scene
from tests.conftest import CallGlsl
from tests.support.builders import MATTE, glass, lamp, scene_of, sphere
from tests.support.numerics import Array

MIRROR = {"type": "metal", "color": [0.9, 0.9, 0.9], "roughness": 0}
ON: dict[str, Any] = {"caustics": "on", "linked": 1.0}
BRANCHES = {"upper": (1.0, 0), "falling": (-1.0, 1), "lower": (-1.0, 0)}  # sign, whether D falls
BRANCH = "Branch(sign, falls != 0)"
KINDS = [(1, "falling"), (1, "lower"), (2, "falling"), (2, "lower")]
KINDS += [(chords, "upper") for chords in (0, 1, 2)]
STEP = 1e-6
ARC = """
    Sphere ball = sphere_at(0);
    ball.center = vec3(0.2, -0.1, 0.3);
    ball.radius = 0.7;
    Arc arc = arc_of(eye, vertex, ball, ior, chords);"""
CENTER, RADIUS = np.array([0.2, -0.1, 0.3]), 0.7


def place() -> Scene:
    materials = {"glass": glass(), "lamp": lamp(2.0), "matte": MATTE, "steel": MIRROR}
    things = [
        sphere([0, 0, -3], 0.5, "glass"),
        sphere([2, 0, -3], 0.5, "steel"),
        sphere([0, 3, -3], 0.1, "lamp"),
    ]
    return scene_of(things, materials)


class Traced(NamedTuple):
    """Rays from eyes that meet the ball, and leave it; arrays of n rows."""

    sine: Array  # of the angle of incidence
    near: Array  # where they meet it first
    far: Array  # where they leave it
    direction: Array  # in which they leave


def traced(eye: Array, direction: Array, ior: Array, chords: int) -> Traced:
    """Float64, by the vector form of Snell's law."""
    to_center = CENTER - eye
    along = (to_center * direction).sum(1)
    beside2 = (to_center**2).sum(1) - along**2
    near = eye + (along - np.sqrt(RADIUS**2 - beside2))[:, None] * direction
    normal = (near - CENTER) / RADIUS
    cosine = -(direction * normal).sum(1)
    if chords == 0:
        return Traced(sine_of(cosine), near, near, direction + 2 * cosine[:, None] * normal)
    way, far = refracted(direction, normal, 1 / ior), near
    for chord in range(chords):
        far = far - 2 * ((far - CENTER) * way).sum(1)[:, None] * way
        inner = (CENTER - far) / RADIUS
        if chord < chords - 1:
            way = way - 2 * (way * inner).sum(1)[:, None] * inner
    return Traced(sine_of(cosine), near, far, refracted(way, inner, ior))


def sine_of(cosine: Array) -> Array:
    return np.asarray(np.sqrt((1 - cosine) * (1 + cosine)))


def refracted(direction: Array, normal: Array, eta: Array) -> Array:
    cosine = -(direction * normal).sum(1)
    inner = np.sqrt(1 - eta**2 * (1 - cosine**2))
    return np.asarray(eta[:, None] * direction + (eta * cosine - inner)[:, None] * normal)


def unit(vectors: Array) -> Array:
    return np.asarray(vectors / np.linalg.norm(vectors, axis=1, keepdims=True))


def across(direction: Array) -> tuple[Array, Array]:
    """Two unit vectors across unit vectors and each other."""
    other = np.where(np.abs(direction[:, :1]) < 0.5, [[1.0, 0, 0]], [[0.0, 1, 0]])
    u = unit(np.cross(direction, other))
    return u, np.cross(direction, u)


class Links(NamedTuple):
    """Eyes and vertices that are linked, n rows of each."""

    chords: int
    eye: Array
    vertex: Array
    ior: Array
    way: Traced
    start: Array  # directions from the eye
    spread: Array  # solid angle at the eye over area at the vertex, across the ray

    def inputs(self) -> dict[str, Array]:
        """The inputs of ARC and of a crossing."""
        ends = {"eye": self.eye, "vertex": self.vertex, "ior": self.ior}
        return {**ends, "sine": self.way.sine, "chords": np.full(len(self.eye), self.chords)}


def links(chords: int, count: int = 20_000) -> Links:
    """Random ones, with their spread by differences of rays."""
    random = np.random.default_rng(11 + chords)
    distance = RADIUS * random.uniform(1.05, 6, count)
    eye = CENTER + distance[:, None] * unit(random.normal(size=(count, 3)))
    ior = random.uniform(1.1, 2.2, count)
    axis = (CENTER - eye) / distance[:, None]
    u, v = across(axis)
    sine, turn = RADIUS / distance * random.uniform(0.01, 0.99, count), random.uniform(0, 7, count)
    beside = np.cos(turn)[:, None] * u + np.sin(turn)[:, None] * v
    start = np.sqrt(1 - sine**2)[:, None] * axis + sine[:, None] * beside
    way = traced(eye, start, ior, chords)
    vertex = way.far + random.uniform(0.05, 5, count)[:, None] * way.direction
    edges = []
    for side in across(start):
        other = traced(eye, unit(start + STEP * side), ior, chords)
        apart = ((vertex - other.far) * way.direction).sum(1)
        apart /= (other.direction * way.direction).sum(1)
        edges.append((other.far + apart[:, None] * other.direction - vertex) / STEP)
    area = np.abs((np.cross(*edges) * way.direction).sum(1))
    return Links(chords, eye, vertex, ior, way, start, 1 / area)


@pytest.mark.parametrize("chords", [0, 1, 2])
def test_a_link_spreads_as_rays_do(call_glsl: CallGlsl, chords: int) -> None:
    found = links(chords)
    spread = call_glsl(
        "spread_of(arc, crossing_of(arc, sine))",
        scene=place(),
        options=ON,
        setup=ARC,
        **found.inputs(),
    )
    is_there = spread > 0
    assert is_there.mean() > (0.7 if chords == 2 else 0.9)  # but folds, and eyes close to it
    assert_allclose(spread[is_there], found.spread[is_there], rtol=2e-2)
    assert np.median(np.abs(spread / found.spread - 1)[is_there]) < 1e-5


def inputs_of(branch: tuple[float, int]) -> dict[str, Array]:
    """The inputs of BRANCH."""
    return {"sign": np.array([branch[0]]), "falls": np.array([branch[1]])}


def ways_found(call_glsl: CallGlsl, chords: int) -> tuple[Links, dict[str, Array]]:
    """The sines of incidence that the branches find, of links that are there; NaN: none."""
    found = links(chords)
    usual: dict[str, Any] = {"scene": place(), "options": ON, "setup": ARC}
    usual |= found.inputs()
    slope = call_glsl("crossing_of(arc, sine).slope", **usual)
    fits = call_glsl("has_links(arc)", "bool", **usual) & (np.abs(slope) > 0.0625)
    sines = {}
    for name, branch in BRANCHES.items():
        m = call_glsl(f"meeting_of(arc, {BRANCH})", **usual, **inputs_of(branch))
        m = m.astype(np.float64)
        sines[name] = np.where((m >= 0) & fits, 2 * m / (1 + m * m), np.nan)
    told = np.where(fits, slope, np.nan)
    return found, {**sines, "slope": told}


@pytest.mark.parametrize("chords", [0, 1, 2])
def test_every_way_of_light_is_found(call_glsl: CallGlsl, chords: int) -> None:
    """One of the branches finds it, and so does the branch that its slope names."""
    found, sines = ways_found(call_glsl, chords)
    slope = sines.pop("slope")
    off = {name: np.abs(sine - found.way.sine) for name, sine in sines.items()}
    falls = slope < 0
    one = np.fmin(off["upper"], off["lower"])
    nearest = np.where(falls, off["falling"], one)[~np.isnan(slope)]
    room = 3e-6 / np.minimum(1, np.abs(slope[~np.isnan(slope)]))
    assert (nearest < room).all()  # NaN, which none finds, is no such number
    assert nearest.size > 10_000


def sense_of(found: Links) -> Array:
    """1: the way turns about the centre from the eye towards the vertex; -1: the other way."""
    eye, vertex, near = (p - CENTER for p in (found.eye, found.vertex, found.way.near))
    return np.asarray(np.sign((np.cross(eye, vertex) * np.cross(eye, near)).sum(1)))


@pytest.mark.slow_cases("2-upper")
@pytest.mark.parametrize(("chords", "branch"), KINDS)
def test_each_branch_is_met(call_glsl: CallGlsl, chords: int, branch: str) -> None:
    """Each branch also turns in the sense that it reports."""
    found, sines = ways_found(call_glsl, chords)
    is_met = np.abs(sines[branch] - found.way.sine) < 1e-5
    assert is_met.sum() > 50
    usual: dict[str, Any] = {"scene": place(), "options": ON, "chords": np.array([chords])}
    (told,) = call_glsl(f"sense_of({BRANCH}, chords)", **usual, **inputs_of(BRANCHES[branch]))
    assert (sense_of(found)[is_met] == told).mean() > 0.99  # except with eye and vertex in line


@pytest.mark.slow
@pytest.mark.parametrize("chords", [0, 1, 2])
def test_a_way_runs_where_rays_do(call_glsl: CallGlsl, chords: int) -> None:
    """Where it meets the ball on both sides, and where it leaves the eye."""
    found = links(chords)
    film = "void splat(vec2 place, vec3 radiance, int layer) {}\n"
    files = film + read("integrators/particle_start.glsl")
    usual: dict[str, Any] = {
        "scene": place(),
        "options": ON,
        "functions": files + read("integrators/camera_links.glsl"),
        **found.inputs(),
    }
    true = {"near": found.way.near, "far": found.way.far, "direction": found.start}
    way = "Way way = way_of(arc, ball.center, crossing_of(arc, sine), sense);"
    for name, expected in true.items():
        setup = ARC + way
        got = call_glsl(f"way.{name}", "vec3", setup=setup, sense=sense_of(found), **usual)
        apart = np.abs(got - expected).max(axis=1)
        assert np.quantile(apart, 0.99) < 1e-5  # beyond: eye, centre and vertex in line
        assert np.quantile(apart, 0.999) < 1e-3


@pytest.mark.slow
def test_links_are_drawn_as_their_shares_say(call_glsl: CallGlsl) -> None:
    u = (np.arange(10_000) + 0.5) / 10_000
    expected_shares: dict[int, list[float]] = {0: [0.125, 0.75, 0.125], 1: [1, 0, 0]}
    for material, expected in expected_shares.items():
        mine = f"material_at(sphere_at({material}).material)"
        drawn = call_glsl(f"draw_chords({mine}, u)", "int", scene=place(), options=ON, u=u)
        shares = [(drawn == chords).mean() for chords in range(3)]
        assert_allclose(shares, expected, atol=1e-3)
        for chords in [n for n, share in enumerate(expected) if share]:
            told = f"2.0 * share_of_draws({mine}, {chords}) + 0.0 * u"
            assert_allclose(
                call_glsl(told, scene=place(), options=ON, u=u[:1]), shares[chords], atol=1e-3
            )


@pytest.mark.parametrize("vertex", [[4.0, 0.0, 0.3], [1.0, -0.2, 0.3]])
def test_branches_are_drawn_as_their_shares_say(call_glsl: CallGlsl, vertex: list[float]) -> None:
    """One alone where D rises at once, three where it falls first."""
    u = (np.arange(4096) + 0.5) / 4096
    usual: dict[str, Any] = {"scene": place(), "options": ON, "setup": ARC, "u": u}
    usual |= {
        "eye": np.array([[-3.0, 0.2, 0.3]]),
        "vertex": np.array([vertex]),
        "ior": np.array([1.5]),
        "chords": np.array([1]),
    }
    sign = call_glsl("draw_branch(arc, u).sign", **usual)
    falls = call_glsl("draw_branch(arc, u).falls", "bool", **usual)
    share = {
        way: call_glsl(f"share_of_branch(arc, {way}) + 0.0 * u", **usual)[0]
        for way in ("true", "false")
    }
    assert falls[sign > 0].sum() == 0
    if vertex[0] > 2:
        assert share["false"] == 1
        assert (sign > 0).all()
        return
    for got, told in (((sign > 0), "false"), (falls, "true"), ((sign < 0) & ~falls, "false")):
        assert abs(got.mean() - share[told]) < 1e-3


@pytest.mark.slow
def test_glass_sends_fresnel_s_share(call_glsl: CallGlsl) -> None:
    sine = np.linspace(0.01, 0.99, 99)
    inner = sine / 1.5
    a, b = np.sqrt(1 - sine**2), np.sqrt(1 - inner**2)
    s, p = (a - 1.5 * b) / (a + 1.5 * b), (1.5 * a - b) / (1.5 * a + b)
    f = (s**2 + p**2) / 2
    for chords, expected in enumerate((f, (1 - f) ** 2, (1 - f) ** 2 * f)):
        crossing = "Crossing(vec3(0.0), sine, sqrt(1.0 - sine * sine), 1.0)"
        mine = "material_at(sphere_at(0).material)"
        got = call_glsl(
            f"chance_of({mine}, {crossing}, {chords})", scene=place(), options=ON, sine=sine
        )
        assert_allclose(got, expected, rtol=2e-5)


@pytest.mark.parametrize("chords", [0, 1, 2])
def test_tinted_glass_takes_its_share_of_each_chord(call_glsl: CallGlsl, chords: int) -> None:
    found = links(chords)
    color, distance = np.array([0.2, 0.5, 0.9]), 0.3
    tint = {"attenuation_color": color.tolist(), "attenuation_distance": distance}
    tinted = scene_of(
        [sphere([0, 0, -3], 0.5, "glass"), sphere([0, 3, -3], 0.1, "lamp")],
        {"glass": glass(**tint), "lamp": lamp(2.0)},
    )
    got = call_glsl(
        "tint_of(material_at(sphere_at(0).material), arc, crossing_of(arc, sine))",
        "vec3",
        scene=tinted,
        options=ON,
        setup=ARC,
        **found.inputs(),
    )
    inside = 2 * chords * RADIUS * np.sqrt(1 - (found.way.sine / found.ior) ** 2)
    assert_allclose(got, color ** (inside[:, None] / distance), rtol=1e-4)
