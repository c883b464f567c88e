"""AOVs against float64: means over pixels by quadrature, single rays, and how good errors are."""

import math
from typing import Any

import numpy as np
import pytest

from glrt.gpu.context import Context
from glrt.image.aovs import AovImage
from glrt.image.sources import load
from glrt.scene.scene import Scene
from glrt.scene.shapes.kinds import KINDS
from tests.conftest import CallGlsl
from tests.support.alarms import SIGMAS, assert_near, book
from tests.support.aov_scenes import heap, world
from tests.support.builders import plane, quad, sphere
from tests.support.first_hits import (
    MEANS,
    PixelMeans,
    assert_mean_is,
    axes_of,
    even,
    first_hits,
    gathered,
    pixel_means,
    smooth,
)
from tests.support.numerics import Array
from tests.support.renders import SAMPLERS, rendering

SIZE = (8, 8)
EYE = {"position": [0.3, 0.2, 0.1], "look_at": [0.1, 0.3, -1.0], "fov": 80.0}
BALL = world(sphere([0.2, 0.1, -4], 2.2, "paint"), **EYE)
TILTED = world(quad([-1.5, -1, -1.5], [2.5, 0.5, -1], [0.25, 2, -0.5], "paint"), **EYE)
WITHIN = world(sphere([0, 0, 0], 1.0, "paint"), **EYE)
FLAT = world(plane([0, 0, -2], [0.2, 0.5, 1], "paint"), **EYE)


# --- means over pixels ---------------------------------------------------------------------------


@pytest.mark.parametrize("scene", [BALL, TILTED], ids=["ball", "quad"])
def test_means_over_pixels_with_edges_are_those_of_float64(context: Context, scene: Scene) -> None:
    """Samples that miss the shape count as normals of 0, but not as distances."""
    samples, truth = 1024, pixel_means(scene, SIZE, even(64))
    found = gathered(scene, context, samples)
    assert_shares(found["depth"], samples, truth)
    is_known = truth.coverage > 0.1
    assert 15 < is_known.sum() < 60
    assert_mean_is(found["depth"], truth.depth, 0.08, floor=5e-4, where=is_known)
    assert_mean_is(found["position"], truth.position, 0.1, floor=5e-4, where=is_known)
    normal = np.nan_to_num(truth.normal) * truth.coverage[..., None]
    assert_mean_is(found["normal"], normal, 0.1, floor=2e-3)


def assert_shares(depth: AovImage, samples: int, truth: PixelMeans) -> None:
    """Pixels count the samples that met something; some are full, some empty, most of edges not."""
    assert depth.count is not None
    share = truth.coverage
    deviation = np.sqrt(share * (1 - share) / samples + 2e-3**2)
    book()
    scores = np.abs(depth.count / samples - share) / deviation
    assert scores.max() <= SIGMAS + 1  # of the worst of 64
    assert (share == 0).any()
    assert ((share > 0.2) & (share < 0.8)).any()
    assert (depth.count[share == 0] == 0).all()
    assert (depth.count[share == 1] >= samples - 1).all()


@pytest.mark.parametrize("scene", [WITHIN, FLAT], ids=["within a ball", "tilted plane"])
def test_means_over_smooth_pixels_are_those_of_float64(context: Context, scene: Scene) -> None:
    truth = pixel_means(scene, SIZE, smooth())
    found = gathered(scene, context, 1024)
    is_whole = (truth.coverage > 1 - 1e-12) & (found["depth"].value < 9)
    assert is_whole.sum() > 40
    scale = 0.08 if scene is WITHIN else 0.6
    assert_mean_is(found["depth"], truth.depth, scale, floor=1e-6, where=is_whole)
    assert_mean_is(found["position"], truth.position, scale, floor=1e-6, where=is_whole)
    assert_mean_is(found["normal"], truth.normal, 0.08, floor=1e-6, where=is_whole)


def test_blocks_at_an_edge_count_where_a_sample_of_theirs_meets_something(
    context: Context,
) -> None:
    samples, blocks = 128, 8
    depth = gathered(BALL, context, samples, sampler="sobol")["depth"]
    assert depth.count is not None
    assert depth.observations is not None
    assert depth.stderr is not None
    least = -(-depth.count.astype(int) // 16)
    assert (least <= depth.observations).all()
    assert (depth.observations <= np.minimum(blocks, depth.count)).all()
    assert ((depth.count > 0) & (depth.count < samples)).sum() > 10
    assert ((depth.observations > 0) & (depth.observations < blocks)).any()
    assert np.array_equal(np.isnan(depth.stderr), depth.observations < 2)


# --- single rays ---------------------------------------------------------------------------------

RAY = """
    Sampler rng = sampler_at(ivec2(pixel), 0, frame.seed);
    Ray ray = camera_ray(frame.camera, vec2(frame.size), pixel, rng);"""


def camera_rays(call_glsl: CallGlsl, scene: Scene) -> tuple[Array, Array]:
    """Origins, relative to the camera, and directions of the first paths, (H, W, 3) each."""
    width, height = scene.render.width, scene.render.height
    x, y = np.meshgrid(np.arange(width), np.arange(height))
    pixels = np.stack([x.ravel(), y.ravel()], axis=-1).astype(np.float32)
    found = (
        call_glsl(f"ray.{what}", "vec3", setup=RAY, scene=scene, pixel=pixels)
        for what in ("origin", "direction")
    )
    origins, ways = (rows.reshape(height, width, 3).astype(np.float64) for rows in found)
    return origins, ways


def sized(scene: Scene, width: int = 16, height: int = 12) -> Scene:
    render = scene.render.model_copy(update={"width": width, "height": height, "bounces": 0})
    return scene.model_copy(update={"render": render})


@pytest.mark.parametrize("name", ["weekend", "heap"])
def test_aovs_report_what_the_camera_rays_of_paths_meet(
    context: Context, call_glsl: CallGlsl, name: str
) -> None:
    """Rays meet a tree of 484 balls through a lens; another case has neither."""
    scene = sized(load("weekend") if name == "weekend" else heap())
    origins, ways = camera_rays(call_glsl, scene)
    eye = np.array(scene.camera.position)
    truth = first_hits(scene, eye + origins, ways)
    found = gathered(scene, context, 1, width=16, height=12)
    is_met = truth.object > 0
    assert (found["depth"].count == is_met).all()  # type: ignore[union-attr]
    assert 0.3 < is_met.mean() < 1
    depth = found["depth"].value[is_met]
    assert np.abs(depth / truth.depth[is_met] - 1).max() < 1e-5
    away = np.abs(found["position"].value - truth.position)[is_met].max(axis=-1)
    assert (away < 1e-5 * depth).all()
    assert np.abs(found["normal"].value - truth.normal)[is_met].max() < 1e-3  # of small balls
    assert np.abs(found["albedo"].value - albedos(scene, truth.object)).max() < 1e-7


def albedos(scene: Scene, objects: Array) -> Array:
    """The albedos of objects by number, from the scene's own models; 0 for no object."""
    materials = [scene.materials[shape.material] for shape in scene.objects]
    colors = [(0, 0, 0), *(getattr(m, "color", (1, 1, 1)) for m in materials)]
    found: Array = np.array(colors)[objects]
    return found


def test_the_nearest_of_a_tree_is_that_of_the_scene_itself(
    context: Context, call_glsl: CallGlsl
) -> None:
    """The truth is the geometry that picking uses, one ray at a time."""
    scene = sized(load("weekend"))
    origins, ways = camera_rays(call_glsl, scene)
    found = gathered(scene, context, 1, width=16, height=12)["depth"].value
    forward = axes_of(scene.camera)[2]
    for place in np.ndindex(found.shape):
        distance = nearest(scene, scene.camera.position + origins[place], ways[place])
        depth = (origins[place] + distance * ways[place]) @ forward if distance < np.inf else np.inf
        assert found[place] == pytest.approx(depth, rel=1e-5)


def nearest(scene: Scene, origin: Array, way: Array) -> float:
    found = [math.inf]
    for kind in KINDS.values():
        rows = [shape.row for shape in scene.objects if type(shape) is kind]
        with np.errstate(invalid="ignore", divide="ignore"):
            found.extend(kind.distances(np.array(rows), origin, way) if rows else [])
    return float(min(found))


# --- standard errors -----------------------------------------------------------------------------


def deviations(
    context: Context, scene: Scene, samples: int, renders: int, **settings: Any
) -> dict[str, tuple[Array, Array]]:
    """Values and standard errors of each AOV that is a mean, (renders, H, W, C), of new seeds."""
    values: dict[str, list[Any]] = {name: [] for name in MEANS}
    options = {"width": 8, "height": 8, "bounces": 0, "aov": MEANS, **settings}
    with rendering(scene, context, **options) as renderer:
        for seed in range(renders):
            renderer.update(seed=1000 + seed)
            for name, aov in renderer.render(samples).image().aovs.items():
                values[name].append((aov.value, aov.stderr))
    stacked = {name: np.array(pairs, np.float64) for name, pairs in values.items()}
    return {name: (pairs[:, 0], pairs[:, 1]) for name, pairs in stacked.items()}


@pytest.mark.parametrize("sampler", SAMPLERS)
def test_errors_of_positions_on_a_wall_are_what_seeds_show(context: Context, sampler: str) -> None:
    """Every pixel has the same spread: chi-square, of as many degrees as there are means.

    The estimates themselves have k - 1 degrees each, for k observations; so the ratio of variances
    deviates by sqrt(2 (1 + 1 / (k - 1)) / means). In blocks, x and y share their points.
    """
    renders, samples = 48, 64
    wall = world(plane([0, 0, -3], [0, 0, 1], "paint"))
    values, errors = deviations(context, wall, samples, renders, sampler=sampler)["position"]
    places = 3 * ((2 * np.arange(8) + 1) / 8 - 1)
    truth = np.stack(np.meshgrid(places, -places), axis=-1)
    apart = values[..., :2] - truth
    ratio = np.square(apart).sum() / np.square(errors[..., :2]).sum()
    observations = samples if sampler == "independent" else samples // 16
    means = apart.size if sampler == "independent" else apart.size / 2
    assert_near(ratio, 1, math.sqrt(2 * (1 + 1 / (observations - 1)) / means))


@pytest.mark.slow
@pytest.mark.parametrize("samples", [64, 256])
@pytest.mark.parametrize("sampler", SAMPLERS)
def test_errors_of_all_aovs_are_what_seeds_show(
    context: Context, sampler: str, samples: int
) -> None:
    """Also at edges, in pixels that few samples of some blocks meet; 256 renders, to 5 %.

    About the mean over all seeds, since the truth at edges is not known as well.
    """
    ball, sheet = (
        sphere([0.2, 0.1, -4], 1.2, "paint"),
        quad([-3, -2, -6], [5, 0, 0], [1, 3, 0], "steel"),
    )
    scene = world(ball, sheet, fov=45.0)
    found = deviations(context, scene, samples, 256, sampler=sampler)
    assert [*found] == [*MEANS]
    for values, errors in found.values():
        known = np.isfinite(values).all(axis=0) & np.isfinite(errors).all(axis=0)
        known &= errors.mean(axis=0) > 0
        assert known.sum() > 20
        variance = np.where(known, values, 0).var(axis=0, ddof=1)[known]
        ratio = float(np.sqrt((variance / np.square(errors).mean(axis=0)[known]).mean()))
        assert_near(ratio, 1, 0.05 / SIGMAS)
