"""Light through one point that is kept of many: its mean is that of paths, whatever is reused."""

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from glrt.gpu.context import Context
from glrt.gpu.glsl import read
from glrt.image.sources import load
from glrt.rendering.pipelines import Variant
from glrt.scene.scene import Scene
from tests.support.builders import (
    MATTE,
    box,
    disk,
    glass,
    lamp,
    plane,
    quad,
    room_of_planes,
    scene_of,
    sphere,
)
from tests.support.meshes import mesh, quads
from tests.support.renders import rendered, rendering, same
from tests.truths.test_invariance import mixture
from tests.truths.test_probes import ROOMS, room

Floats = NDArray[np.float64]

WAY: dict[str, Any] = {"method": "resampled", "sampler": "sobol", "probes": 2}
REUSES = ("none", "temporal", "spatial", "both")
RESAMPLING = "probes/resampling.glsl"
LIMIT = 6.0  # standard errors, of 64 pictures or more: once in 10^7
MATERIALS: dict[str, dict[str, Any]] = {
    "white": {"type": "lambertian", "color": [0.7, 0.7, 0.7]},
    "red": {"type": "lambertian", "color": [0.6, 0.1, 0.05]},
    "mirror": {"type": "metal", "color": [0.9, 0.9, 0.9]},
    "glass": glass(),
    "lamp": lamp(8.0),
}
LAMPS = {
    "quad": quad([-0.4, 0.9, -0.4], [0.8, 0, 0], [0, 0, 0.8], "lamp"),
    "sphere": sphere([0.1, 0.5, 0.2], 0.2, "lamp"),
    "disk": disk([0, 0.7, 0], [0.3, 1, 0], 0.3, "lamp"),
    "mesh": mesh(quads([[-0.4, 0.9, -0.4], [0.8, 0, 0], [0, 0, 0.8]]), "lamp"),
    "box": box([-0.3, 0.6, -0.3], [0.3, 0.8, 0.3], "lamp"),
}
EYE = {"position": [0.1, 0.05, 0.95], "look_at": [0, -0.2, -1], "fov": 80}


def lit_by(name: str, **more: Any) -> Scene:
    """A room with balls and a mirror."""
    things = [
        *room_of_planes("white"),
        LAMPS[name],
        sphere([-0.4, -0.7, -0.3], 0.3, "red"),
        sphere([0.4, -0.75, -0.2], 0.25, "white"),
        quad([-0.9, -0.6, -0.95], [0.7, 0, 0], [0, 0.9, 0], "mirror"),
    ]
    return scene_of(things, {**MATERIALS, "lamp": lamp(8.0, **more)}, EYE)


def means(scene: Scene, context: Context, seeds: int, first: int = 0, **settings: Any) -> Floats:
    """Means of pictures of an observation each, by other seeds: independent, unlike pixels."""
    ways = {**WAY, "width": 24, "height": 24, "samples": 16, **settings}
    found = []
    with rendering(scene, context, **ways) as renderer:
        for seed in range(first, first + seeds):
            renderer.update(seed=seed)
            found.append(renderer.render().image().radiance.mean(dtype=np.float64))
    return np.array(found)


def assert_equal_means(found: Floats, truth: Floats, within: float) -> None:
    """Means agree up to LIMIT standard errors, which together are at most `within` of the mean."""
    error = float(np.sqrt(found.var(ddof=1) / len(found) + truth.var(ddof=1) / len(truth)))
    difference = float(found.mean() - truth.mean())
    assert abs(difference) < LIMIT * error, f"{difference / error:.1f} standard errors"
    assert LIMIT * error < within * truth.mean()


# --- means ------------------------------------------------------------------------------------


@pytest.mark.slow
@pytest.mark.slow_cases("both", "temporal", "none")
@pytest.mark.parametrize("reuse", REUSES)
def test_direct_light_and_one_bounce_are_those_of_paths(context: Context, reuse: str) -> None:
    """Without probes nothing is left out; `both` has the most noise in common."""
    scene = lit_by("quad")
    seeds = 256 if reuse == "both" else 96
    truth = means(scene, context, 96, 1000, method="mis", bounces=2)
    found = means(scene, context, seeds, bounces=2, reuse=reuse)
    assert_equal_means(found, truth, 0.06 if reuse == "both" else 0.02)


@pytest.mark.slow
@pytest.mark.parametrize("name", LAMPS)
def test_points_on_all_kinds_of_lamps_are_weighed_next_to_scattering(
    context: Context, name: str
) -> None:
    scene = lit_by(name)
    truth = means(scene, context, 64, 1000, method="mis", bounces=1)
    assert_equal_means(means(scene, context, 64, bounces=1, reuse="spatial"), truth, 0.06)


@pytest.mark.slow
def test_lamps_with_a_cone_are_left_to_paths(context: Context) -> None:
    scene = lit_by("disk", cone={"axis": [0, -1, 0], "inner": 30, "outer": 50})
    truth = means(scene, context, 64, 1000, method="mis", bounces=2)
    assert_equal_means(means(scene, context, 64, bounces=2, reuse="spatial"), truth, 0.1)


@pytest.mark.slow
def test_the_light_of_all_bounces_is_that_of_a_gather(context: Context) -> None:
    scene = lit_by("sphere")
    truth = means(scene, context, 64, 1000, method="gather", bounces=6)
    assert_equal_means(means(scene, context, 64, bounces=6), truth, 0.05)


@pytest.mark.slow
def test_light_of_the_sky_and_the_sun_is_left_to_paths(context: Context) -> None:
    things = [
        plane([0, -1, 0], [0, 1, 0], "white"),
        sphere([-0.4, -0.6, -1.3], 0.4, "red"),
        sphere([0.5, -0.7, -1.2], 0.3, "glass"),
        LAMPS["sphere"],
    ]
    sun = {"direction": [0.4, 1, 0.3], "irradiance": [1.0, 1.0, 1.0], "angle": 2.0}
    sky = {"color": [0.5, 0.6, 0.8]}
    scene = scene_of(things, MATERIALS, EYE, background=sky, sun=sun)
    truth = means(scene, context, 64, 1000, method="mis", bounces=2)
    assert_equal_means(means(scene, context, 64, bounces=2), truth, 0.03)


@pytest.mark.slow
def test_what_a_surface_has_found_is_not_hidden_from_it(context: Context) -> None:
    """A point lies on a surface up to rounding, which would hide it in one of a hundred cases."""
    text = read(RESAMPLING)
    line = "    Reservoir result = own;\n"
    told = "path.radiance = vec3(own.weight > 0.0 ? 1.0 : 0.0, hidden ? 1.0 : 0.0, 0.0);"
    asked = "bool hidden = own.weight > 0.0 && is_hidden(own.at, own.kept);"
    assert text.count(line) == 1
    text = text.replace(
        line, f"{line}    {asked}\n    {told}\n    if (frame.bounces > 0) return;\n"
    )
    ways: dict[str, Any] = {**WAY, "reuse": "none", "bounces": 2, "width": 64, "height": 64}
    for name in ("methods/diffuse", "cornell"):
        image = rendered(load(name), context, 64, **ways, variant=Variant({}, {RESAMPLING: text}))
        found, hidden, _ = image.radiance.mean(axis=(0, 1))
        assert found > 0.5
        assert hidden < 1e-5  # rays at the rim of a shape


@pytest.mark.slow
def test_a_point_that_is_asked_for_five_times_counts_once(context: Context) -> None:
    """All five are one pixel's point: rays must give the same answer for each."""
    text = read(RESAMPLING)
    radius = "int most = max(int(float(frame.size.y) * NEAR_PART), 1);"
    assert text.count(radius) == 1
    variant = Variant({}, {RESAMPLING: text.replace(radius, "int most = 0;")})
    scene = load("methods/diffuse")
    truth = means(scene, context, 128, method="mis", bounces=2)
    found = means(scene, context, 128, 1000, bounces=2, variant=variant)
    assert_equal_means(found, truth, 0.02)


def fence() -> Scene:
    """Slats on a floor, from near: of two neighbours often one sees what the other does not."""
    slats = [quad([0.1 * i - 0.5, -1, -0.6], [0, 0, 0.9], [0, 0.3, 0], "white") for i in range(11)]
    things = [*room_of_planes("white"), LAMPS["quad"], *slats]
    return scene_of(things, MATERIALS, {"position": [0, -0.2, 0.6], "look_at": [0, -1, -0.2]})


@pytest.mark.slow
def test_points_that_neighbours_do_not_see_keep_the_mean(context: Context) -> None:
    """The biased form is too dark there."""
    ways: dict[str, Any] = {"bounces": 2, "reuse": "spatial"}
    truth = means(fence(), context, 96, 1000, method="mis", bounces=2)
    assert_equal_means(means(fence(), context, 96, **ways), truth, 0.02)
    found = means(fence(), context, 96, **ways, unbiased=False)
    error = np.sqrt(found.var(ddof=1) / len(found) + truth.var(ddof=1) / len(truth))
    assert found.mean() - truth.mean() < -LIMIT * error


# --- noise ------------------------------------------------------------------------------------


@pytest.mark.slow
def test_reuse_of_pixels_around_takes_noise_from_a_picture(context: Context) -> None:
    """At equal samples; what a pixel has kept itself adds noise, for samples share it."""
    scene = load("methods/diffuse")
    ways: dict[str, Any] = {**WAY, "bounces": 2, "width": 96, "height": 96}
    found = {
        reuse: np.square(rendered(scene, context, 64, reuse=reuse, **ways).stderr).mean()
        for reuse in REUSES
    }
    assert found["spatial"] < 0.85 * found["none"]
    assert found["temporal"] > 1.3 * found["none"]


@pytest.mark.slow
def test_the_error_reports_the_noise_of_what_samples_share(context: Context) -> None:
    """Over seeds, pictures vary as each of them says."""
    scene, images = load("methods/diffuse"), []
    ways: dict[str, Any] = {**WAY, "reuse": "both", "width": 12, "height": 12, "bounces": 2}
    with rendering(scene, context, **ways) as renderer:
        for seed in range(64):
            renderer.update(seed=seed)
            images.append(renderer.render(128).image())
    told = np.mean([np.square(image.stderr) for image in images], axis=0)
    spread = np.var([image.radiance for image in images], axis=0, ddof=1)
    assert 0.7 < spread.sum() / told.sum() < 1.4


# --- bits -------------------------------------------------------------------------------------


@pytest.mark.slow
def test_light_without_a_bounce_is_that_of_mis_to_the_bit(context: Context) -> None:
    ways = {"bounces": 0, "sampler": "sobol"}
    found = rendered(mixture(), context, 16, **{**WAY, **ways})
    assert same(found, rendered(mixture(), context, 16, method="mis", **ways))


@pytest.mark.slow
@pytest.mark.slow_cases("planes")
@pytest.mark.parametrize("name", ROOMS)
def test_three_bounces_in_a_closed_room_are_exact(context: Context, name: str) -> None:
    """1 + a + a^2 + a^3: what is kept counts for what is not."""
    image = rendered(room(name, 0.5), context, 16, **WAY, reuse="none", bounces=3)
    np.testing.assert_allclose(image.radiance, 1.875, rtol=1e-5)


@pytest.mark.slow
@pytest.mark.parametrize("reuse", ["none", "both"])
def test_a_scene_scaled_by_a_power_of_two_keeps_its_bits(context: Context, reuse: str) -> None:
    ways = {**WAY, "reuse": reuse}
    expected = rendered(mixture(), context, 16, **ways)
    for power in (-9, -1, 4, 10):
        assert same(rendered(mixture(2.0**power), context, 16, **ways), expected), power


@pytest.mark.slow
@pytest.mark.slow_cases("temporal", "spatial")
@pytest.mark.parametrize("reuse", REUSES)
def test_the_picture_does_not_hang_on_what_was_rendered_before(
    context: Context, reuse: str
) -> None:
    """Earlier renders had other settings, or took a few samples at a time."""
    scene = load("methods/diffuse")
    ways = {**WAY, "reuse": reuse, "samples": 48}
    with rendering(scene, context, **ways) as renderer:
        expected = renderer.render().image()
        renderer.restart()
        for samples in (5, 11, 1, 20, 11):
            renderer.step(samples)
        assert same(renderer.image(), expected)
        renderer.update(seed=1)
        assert not same(renderer.render(40).image(), expected)
        renderer.update(seed=0)
        assert same(renderer.render().image(), expected)


def test_a_part_is_its_own_share_of_the_whole(context: Context) -> None:
    """Blocks of 16 samples begin with nothing kept."""
    scene, ways = load("methods/diffuse"), {**WAY, "reuse": "both"}
    one, two = (rendered(scene, context, count, **ways).radiance for count in (16, 32))
    with rendering(scene, context, **ways, samples=48, part=(2, 3)) as renderer:
        part = renderer.render().image().radiance
    np.testing.assert_allclose(part, 2 * two - one, rtol=1e-4, atol=1e-5)


@pytest.mark.slow
def test_scenes_with_holes_have_the_picture_of_a_gather(context: Context) -> None:
    """A ray sees through what is there in part at random: whether a point is seen is not known."""
    screen = {"type": "principled", "color": [0.5, 0.5, 0.5], "alpha": 0.5}
    things = [
        *room_of_planes("m"),
        sphere([0.2, 0.5, -0.3], 0.2, "lamp"),
        quad([-0.5, -0.5, -0.5], [1, 0, 0], [0, 1, 0], "screen"),
    ]
    scene = scene_of(things, {"m": MATTE, "lamp": lamp(4.0), "screen": screen})
    expected = rendered(scene, context, 32, **{**WAY, "method": "gather"})
    assert same(rendered(scene, context, 32, **WAY, reuse="both"), expected)
