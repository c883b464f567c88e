"""Samplers follow the densities they report: chi-square on the production code.

The code uses its own random numbers; the test compares with quadratures of its own densities.

A density that is wrong in one place shows in its cell; one that does not integrate to 1, or a
sample where it is 0, fails at once. That weights equal value over density stands in test_material
and test_light; that energy is right, in test_direct_light.
"""

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from tests.conftest import CallGlsl
from tests.shaders.test_dielectric import fresnel64
from tests.shaders.test_light import MANY
from tests.support.alarms import assert_fits
from tests.support.builders import MATTE, glass, scene_of, sphere
from tests.support.numerics import Array, wo_at

Floats = NDArray[np.float64]

DRAWS = 2**18
PIXEL = {"width": 1, "height": 1}
RNG = "Sampler rng = make_sampler(pixel_seed(ivec2(i % 512, i / 512), 0, 3u));"
GRIDS = [
    (10, 20),
    (101, 1),
]  # heights, azimuths: smooth errors show in few cells, others in many


def cells_of(direction: Array, rows: int, columns: int, lowest: float = 0.0) -> Array:
    """How many unit vectors lie in each cell of height (from `lowest` to 1) and azimuth."""
    x, y, z = direction.astype(np.float64).T
    row = np.clip((z - lowest) / (1 - lowest) * rows, 0, rows - 1).astype(int)
    column = (np.arctan2(y, x) / (2 * np.pi) % 1 * columns).astype(int) % columns
    return np.bincount(columns * row + column, minlength=rows * columns)


def integrals(
    call_glsl: CallGlsl,
    density: str,
    grid: tuple[int, int],
    fine: int,
    lowest: float = 0.0,
    **more: Any,
) -> Floats:
    """The integral of a density over each cell of `cells_of`, by fine x fine midpoints.

    `density` is an expression in `wi`. A lane sums one cell.
    """
    rows, columns = grid
    row, column = np.divmod(np.arange(rows * columns), columns)
    setup = f"""
        float sum = 0.0;
        for (int k = 0; k < {fine * fine}; ++k) {{
            vec2 middle = vec2(float(k % {fine}) + 0.5, float(k / {fine}) + 0.5) / {fine}.0;
            float z = {lowest:.1f} + {1 - lowest:.1f} * (float(row) + middle.x) / {rows}.0;
            float phi = 2.0 * PI * (float(column) + middle.y) / {columns}.0;
            vec3 wi = vec3(sqrt(1.0 - z * z) * vec2(cos(phi), sin(phi)), z);
            sum += {density};
        }}"""
    sums = call_glsl("sum", setup=more.pop("setup", "") + setup, row=row, column=column, **more)
    return sums.astype(np.float64) * 2 * np.pi * (1 - lowest) / (rows * columns * fine * fine)


# --- materials -----------------------------------------------------------------------------

VERTEX = """
    Material material =
        Material(vec3(1.0), kind, vec3(0.0), alpha, 1.0, 0, 0, -1, 0.0, 0.0, 1.0, 1.0);
    Vertex vertex = vertex_of(frame_around(vec3(0.0, 0.0, 1.0)), wo, material, true);"""
MATTE_KIND, METAL_KIND = 0, 1


@pytest.mark.parametrize("grid", GRIDS, ids=str)
@pytest.mark.parametrize(
    ("kind", "alpha", "cosine"),
    [
        (MATTE_KIND, 0.0, 0.7),
        *((METAL_KIND, alpha, cosine) for alpha in (0.09, 0.25, 1.0) for cosine in (0.95, 0.3)),
    ],
)
def test_surfaces_scatter_by_their_density(
    call_glsl: CallGlsl, kind: int, alpha: float, cosine: float, grid: tuple[int, int]
) -> None:
    """Directions below the surface are absorbed: they are a cell of their own."""
    given = {"kind": np.array([kind]), "alpha": np.array([alpha])}
    once: dict[str, Any] = {**given, "wo": np.repeat(wo_at(cosine), grid[0] * grid[1], axis=0)}
    fine = 64 if grid[1] > 1 else 256
    share = integrals(call_glsl, "pdf_material(vertex, wi)", grid, fine, setup=VERTEX, **once)
    assert share.sum() < 1 + 1e-4
    if kind == MATTE_KIND:
        assert share.sum() == pytest.approx(1, abs=1e-4)
    setup = RNG + VERTEX + "Scattering next = sample_material(vertex, rng);"
    wo = np.repeat(wo_at(cosine), DRAWS, axis=0)
    sample = "vec4(next.direction, next.weight.x)"
    drawn = call_glsl(sample, "vec4", setup=setup, wo=wo, **given)
    kept = drawn[:, 3] > 0
    counts = np.append(cells_of(drawn[kept, :3], *grid), np.count_nonzero(~kept))
    absorbed = max(1 - share.sum(), 0.0) if kind == METAL_KIND else 0.0
    assert_fits(counts, DRAWS * np.append(share, absorbed))


def test_glass_reflects_as_often_as_fresnel_says(call_glsl: CallGlsl) -> None:
    """From either side, at 32 angles: rays reflected and refracted."""
    cosines = (np.arange(32) + 0.5) / 32
    scene = scene_of([sphere([0, 0, -3], 1, "glass")], {"glass": glass(1.5)})
    place = np.arange(DRAWS) % 32
    for outside, eta in ((1, 1 / 1.5), (0, 1.5)):
        setup = f"""{RNG}
            mat3 around = frame_around(vec3(0.0, 0.0, 1.0));
            Vertex vertex = vertex_of(around, wo, material_at(0), {outside} == 1);
            Scattering next = sample_material(vertex, rng);"""
        wo = wo_at(cosines[place])
        crosses = call_glsl("next.crosses", "bool", setup=setup, scene=scene, wo=wo)
        refracted = np.bincount(place[crosses], minlength=32)
        share = 1 - fresnel64(cosines, eta)
        each = DRAWS / 32
        assert_fits([refracted, each - refracted], [each * share, each * (1 - share)])


# --- lamps ---------------------------------------------------------------------------------

ALL_LAMPS = """float density(vec3 origin, vec3 wi) {
    Ray ray = Ray(origin, wi, NO_SHAPE, false);
    float sum = 0.0;
    for (int k = 0; k < light_count(); ++k) {
        int shape = light_at(k).shape;
        int flat_index = shape - sphere_count() - plane_count();
        float t = 0.0;
        if (flat_index < 0) t = sphere_distance(ray, sphere_at(shape), shape);
        else t = quad_distance(ray, quad_at(flat_index));
        if (t > 0.0) sum += pdf_light(k, ray, t, total_weight(ray));
    }
    return sum;
}"""


@pytest.mark.slow
@pytest.mark.parametrize("place", [(0.0, 0.0, 0.0), (1.7, -0.4, -2.0)])
def test_lamps_are_sampled_by_their_density(
    call_glsl: CallGlsl, place: tuple[float, float, float]
) -> None:
    """Balls and panels of many powers at once: the choice, the cone, the area, the angles."""
    grid = (24, 48)
    once: dict[str, Any] = {"scene": MANY, "functions": ALL_LAMPS, "lowest": -1.0}
    share = integrals(call_glsl, f"density(vec3{place}, wi)", grid, 64, **once)
    assert share.sum() == pytest.approx(1, abs=1e-3)
    setup = f"""{RNG}
        Ray from = Ray(origin, vec3(1.0), NO_SHAPE, false);
        LightSample light = sample_light(from, total_weight(from), rng);"""
    origin = np.tile(place, (DRAWS, 1))
    sample = "vec4(light.ray.direction, light.pdf)"
    drawn = call_glsl(sample, "vec4", setup=setup, scene=MANY, origin=origin)
    assert np.all(drawn[:, 3] > 0)
    counts = cells_of(drawn[:, :3], *grid, lowest=-1.0)
    share[share < 1e-7] = 0  # a cell that a lamp touches at a corner, between midpoints
    assert counts[share == 0].sum() <= 2
    assert_fits(np.where(share > 0, counts, 0), DRAWS * share)


# --- camera and roulette -------------------------------------------------------------------


def test_camera_rays_fill_pixel_and_lens_evenly(call_glsl: CallGlsl) -> None:
    """In the plane of focus a ray shows its place in the pixel, at the camera that on the lens."""
    lens = {"defocus_angle": 10.0, "focus_distance": 2.0, "fov": 90.0}
    scene = scene_of([sphere([0, 0, -9], 1, "m")], {"m": MATTE}, lens, render=PIXEL)
    setup = f"{RNG} Ray ray = camera_ray(frame.camera, vec2(1.0), pixel, rng);"
    setup += "vec3 focus = ray.origin - 2.0 / ray.direction.z * ray.direction;"
    both = "vec4(ray.origin.xy, focus.xy)"
    drawn = call_glsl(both, "vec4", setup=setup, scene=scene, pixel=np.zeros((DRAWS, 2)))
    x, y, across, up = drawn.astype(np.float64).T
    r2 = (x * x + y * y) / (2 * np.tan(np.radians(5))) ** 2
    ring = np.clip(r2 * 10, 0, 9).astype(int)
    turn = (np.arctan2(y, x) / (2 * np.pi) % 1 * 20).astype(int) % 20
    assert_fits(np.bincount(20 * ring + turn, minlength=200), np.full(200, DRAWS / 200))
    columns, rows = (np.clip((c / 2 + 1) * 10, 0, 19).astype(int) for c in (across, up))
    assert_fits(np.bincount(20 * columns + rows, minlength=400), np.full(400, DRAWS / 400))
    place = 4 * (columns // 10 + 2 * (rows // 10)) + turn // 5  # quarters of both
    assert_fits(np.bincount(place, minlength=16), np.full(16, DRAWS / 16))


@pytest.mark.slow
def test_roulette_ends_as_many_paths_as_their_throughput_says(call_glsl: CallGlsl) -> None:
    """Four times their throughput survive."""
    chance = (np.arange(32) + 0.5) / 32
    place = np.arange(DRAWS) % 32
    setup = f"{RNG} vec3 throughput = 0.25 * vec3(0.1 * t, t, 0.0);"
    ended = call_glsl("roulette_ends(throughput, rng)", "bool", setup=setup, t=chance[place])
    counts = np.bincount(place[ended], minlength=32)
    each = DRAWS / 32
    expected = [each * (1 - chance), each * chance]
    assert_fits([counts, each - counts], expected)
