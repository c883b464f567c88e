"""Where particles leave lamps, where they arrive on the film, and how they are weighed."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tests.conftest import CallGlsl
from tests.support.builders import (
    plane,
    scene_of,
    sphere,
)
from tests.support.numerics import directions
from tests.support.particle_starts import (
    AREA,
    BALL,
    CORNERS,
    DISK,
    FAR_BALL,
    FLAT,
    LAMPS,
    MATERIALS,
    ON,
    PLACE,
    ROUND,
    SIDES,
    particle_text,
    scene,
    starts,
)


@pytest.fixture
def particle_files() -> str:
    """The text that follows particles, without a film."""
    return particle_text()


@pytest.mark.parametrize("kind", PLACE)
@pytest.mark.parametrize("aimed", [0.0, 0.9])
def test_directions_from_a_lamp_have_a_density(
    call_glsl: CallGlsl, kind: str, aimed: float
) -> None:
    """Its integral over directions, with their cosine, and over the area is 1."""
    towards = directions(400_000)
    found = call_glsl(
        "pdf_emission(0, p, direction, NOT_AIMED)",
        scene=scene(kind, BALL, FAR_BALL),
        options={**ON, "aimed": aimed},
        direction=towards,
        p=np.array([PLACE[kind]]),
    ).astype(np.float64)
    out = np.array([0, -1.0, 0]) if kind == "sphere" else np.array([0, 1.0, 0])
    cosine = towards @ out
    cosine = np.maximum(cosine, 0) if kind == "sphere" else np.abs(cosine)
    total = 4 * np.pi * AREA[kind] * found * cosine / np.pi
    assert abs(total.mean() - 1) < 5 * total.std() / np.sqrt(total.size)
    assert total.std() / np.sqrt(total.size) < 0.02


def test_no_particle_leaves_a_ball_inwards(call_glsl: CallGlsl) -> None:
    towards = directions(1000)
    found = call_glsl(
        "pdf_emission(0, p, direction, NOT_AIMED)",
        scene=scene("sphere", BALL),
        options=ON,
        direction=towards,
        p=np.array([PLACE["sphere"]]),
    )
    assert ((found > 0) == (towards[:, 1] < 0)).all()


@pytest.mark.slow
def test_lamps_are_chosen_as_their_density_says(call_glsl: CallGlsl) -> None:
    """A quad, a ball and a disk share what particles leave."""
    place = scene_of([ROUND, FLAT, DISK, BALL], MATERIALS)
    u = (np.arange(4096) + 0.5) / 4096
    chosen = call_glsl("choose_emitter(u)", returns="int", scene=place, options=ON, u=u)
    assert set(chosen.tolist()) == {0, 1, 2}
    points = {0: PLACE["sphere"], 1: PLACE["quad"], 2: PLACE["disk"]}
    areas = {0: AREA["sphere"], 1: 2 * AREA["quad"], 2: 2 * AREA["disk"]}
    for number, point in points.items():
        told = call_glsl(
            "pdf_emission(n, p, vec3(0.0, -1.0, 0.0), NOT_AIMED)",
            scene=place,
            options={**ON, "aimed": 0.0},
            n=np.array([number], np.int32),
            p=np.array([point]),
        )
        assert abs((chosen == number).mean() - told[0] * areas[number]) < 1e-3


def test_rays_from_the_camera_have_a_density(call_glsl: CallGlsl) -> None:
    """Its integral over the solid angle of the film is 1."""
    towards = directions(400_000)
    place = scene("quad")
    density = call_glsl("pdf_camera(d)", scene=place, options=ON, d=towards).astype(np.float64)
    tan_y = np.tan(np.radians(place.camera.fov) / 2)
    inside = (towards[:, 2] < 0) & (np.abs(towards[:, :2]).max(axis=1) < -tan_y * towards[:, 2])
    total = 4 * np.pi * density * inside
    assert abs(total.mean() - 1) < 5 * total.std() / np.sqrt(total.size)
    assert total.std() / np.sqrt(total.size) < 0.01


@pytest.mark.parametrize("angle", [0.0, 7.0])
def test_a_particle_arrives_where_the_camera_looks(
    call_glsl: CallGlsl, particle_files: str, angle: float
) -> None:
    """The place on the film of a ray from the camera, met the other way round."""
    place = scene_of([FLAT, BALL], MATERIALS, {"defocus_angle": angle, "focus_distance": 2.5})
    pixels = np.random.default_rng(3).integers(0, 64, (2000, 2)).astype(np.float64)
    found = call_glsl(
        "place_on_film(ray.direction, lens)",
        returns="vec2",
        functions=particle_files,
        scene=place,
        options={**ON, "width": 64, "height": 64},
        setup="""
    Sampler rng = make_sampler(uint(i) * 9781u);
    Sampler again = rng;
    Ray ray = camera_ray(frame.camera, vec2(frame.size), pixel, rng);
    vec2 jitter = next_2d(again);
    vec2 lens = vec2(0.0);
    if (HAS_LENS) lens = sample_disk(next_2d(again));""",
        pixel=pixels,
    )
    inside = (found >= pixels - 1e-3) & (found <= pixels + 1 + 1e-3)
    assert inside.all()


@pytest.mark.slow
def test_the_three_ways_share_all_light(call_glsl: CallGlsl) -> None:
    """Their weights add up to 1, whatever their densities are to each other."""
    random = np.random.default_rng(8)
    kappa, rho, scattered = (10.0 ** random.uniform(-3, 3, 5000) for _ in range(3))
    weights = [
        "emission_beside_particles(ray, Hit(1.5, 0), 0, kappa, rho)",
        "sample_beside_particles(light, scattered, rho)",
        "particle_weight(rho / pdf_emission(0, p, -ray.direction, NOT_AIMED), kappa)",
    ]
    setup = """
    vec3 p = vec3(0.1, 1.0, -3.1);
    vec3 towards = normalized(vec3(0.1, 1.0, 0.2));
    Ray ray = Ray(p - 1.5 * towards, towards, NO_SHAPE, false);
    LightSample light = LightSample(ray, 1.5, kappa * scattered, vec3(0.0), 0, 0, 0);"""
    inputs = {"kappa": kappa, "rho": rho, "scattered": scattered}
    shares = [
        call_glsl(weight, scene=scene("quad", BALL), options=ON, setup=setup, **inputs)
        for weight in weights
    ]
    assert_allclose(np.sum(shares, axis=0), 1, rtol=2e-6)
    assert all((share > 0.5).sum() > 100 for share in shares)


def test_a_weight_is_a_number_at_grazing_angles(call_glsl: CallGlsl) -> None:
    """Where a lamp is sampled a vertex that scattering hardly meets it from."""
    over = np.array([1e-30, 1e-20, 1e-10, 1.0])
    weight = call_glsl("particle_weight(over, 1e25)", scene=scene("quad"), options=ON, over=over)
    assert_allclose(weight, 1 / (1 + (over * 1e25) ** 2), rtol=1e-5, atol=1e-20)


@pytest.mark.parametrize("kind", PLACE)
def test_particles_carry_the_flux_of_their_lamp(
    call_glsl: CallGlsl, particle_files: str, kind: str
) -> None:
    """The mean of what they weigh, where only half of them follow the cosine: pi L A a side."""
    place = scene(kind, BALL, FAR_BALL)
    power = starts(call_glsl, particle_files, place, "particle.power.x + 0.0 * n", "float")
    flux = np.pi * 2.0 * SIDES[kind] * AREA[kind]
    assert abs(power.mean() - flux) < 5 * power.std() / np.sqrt(power.size)
    assert power.std() / np.sqrt(power.size) < 0.02 * flux


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["quad", "disk"])
def test_most_particles_leave_the_side_that_is_close_to_something(
    call_glsl: CallGlsl, particle_files: str, kind: str
) -> None:
    """Most particles that are not aimed do, and each side still has its flux."""
    ceiling = plane([0, 1.05, 0], [0, -1, 0], "matte")
    place = scene(kind, BALL, FAR_BALL, ceiling)
    up = "float(particle.path.ray.direction.y > 0.0)"
    leave_so = starts(call_glsl, particle_files, place, f"{up} + 0.0 * n", "float")
    assert abs(leave_so.mean() - 0.5 * 0.9) < 0.01
    for side in (up, f"(1.0 - {up})"):
        powers = f"particle.power.x * {side} + 0.0 * n"
        power = starts(call_glsl, particle_files, place, powers, "float")
        flux = np.pi * 2.0 * AREA[kind]
        assert abs(power.mean() - flux) < 5 * power.std() / np.sqrt(power.size)
        assert power.std() / np.sqrt(power.size) < 0.02 * flux


def test_none_leaves_the_dark_side_of_a_lamp(call_glsl: CallGlsl, particle_files: str) -> None:
    """This holds whatever is close to it."""
    shining = {**LAMPS["quad"], "emission_side": "front"}
    place = scene_of([shining, BALL, plane([0, 1.05, 0], [0, -1, 0], "matte")], MATERIALS)
    lost = "float(particle.power.x == 0.0) + 0.0 * n"
    assert (starts(call_glsl, particle_files, place, lost, "float") == 0).all()


@pytest.mark.slow
def test_a_lamp_inside_a_ball_aims_none_at_it(call_glsl: CallGlsl, particle_files: str) -> None:
    """From inside, the ball fills no cone: particles that were to be aimed carry nothing."""
    place = scene("quad", sphere([0, 1, -3.1], 1.5, "glass"))
    sizes = "length(particle.path.ray.direction) * float(particle.power.x > 0.0) + 0.0 * n"
    lengths = starts(call_glsl, particle_files, place, sizes, "float")
    carries = lengths > 0
    assert abs(carries.mean() - 0.5) < 0.01
    assert_allclose(lengths[carries], 1, rtol=1e-6)
    power = starts(call_glsl, particle_files, place, "particle.power.x + 0.0 * n", "float")
    assert_allclose(power[carries], 2 * np.pi * 2.0 * 2 * 0.8, rtol=1e-5)


def test_half_of_the_particles_are_aimed(call_glsl: CallGlsl, particle_files: str) -> None:
    """A quarter is aimed at either ball; others go there by the cosine."""
    place = scene("quad", BALL, FAR_BALL)
    hit = "float(closest_hit(particle.path.ray).shape) + 0.0 * n"
    shapes = starts(call_glsl, particle_files, place, hit, "float")
    for number in (1, 2):
        assert (shapes == number).mean() > 0.24


def test_points_on_a_triangle_are_even_in_area(call_glsl: CallGlsl, particle_files: str) -> None:
    """Their mean is its middle, and their spread that of an even density: edges squared over 36."""
    what = "particle.path.ray.origin + 0.0 * vec3(n)"
    points = starts(call_glsl, particle_files, scene("triangle", BALL), what, "vec3")
    assert_allclose(points.mean(axis=0), CORNERS.mean(axis=0), atol=3e-3)
    sides = CORNERS - np.roll(CORNERS, 1, axis=0)
    assert_allclose(points.var(axis=0).sum(), np.square(sides).sum() / 36, rtol=0.02)
