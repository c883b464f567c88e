"""Many lamps are chosen in clusters: what lies close together is weighed as one, at each point."""

from itertools import product

import numpy as np
import pytest
from numpy.testing import assert_allclose

from glrt.accel.light_clusters import grouped, light_probabilities
from glrt.gpu.context import Context
from glrt.packing import lights
from glrt.packing.lamp_bounds import bodies_of
from glrt.packing.lights import PARTS, radiance
from glrt.packing.shapes import in_order
from glrt.plan import facts
from glrt.plan.facts import MOST_NEAR
from glrt.scene.scene import Scene
from tests.conftest import CallGlsl
from tests.shaders.test_light import LAMPS
from tests.support.alarms import assert_fits
from tests.support.builders import plane, quad, scene_of, sphere
from tests.support.numerics import BELOW_ONE, Array
from tests.support.packed import packed
from tests.support.renders import assert_agree, rendered

COUNTS = [MOST_NEAR + 1, 100, 999]
FROM = "Ray from = Ray(origin, vec3(0.0, 1.0, 0.0), NO_SHAPE, false);"
CHOICE = f"{FROM} float total = total_weight(from);"
DRAWS = 2**18


def mixed(count: int) -> Scene:
    """Balls and panels, dark ones among them, of sizes that give powers over four orders."""
    random = np.random.default_rng(count)
    places, sizes = random.uniform(-2, 2, (count, 3)), 10.0 ** random.uniform(-3, -1, count)
    kinds = random.choice(["lamp", "bright", "dark"], count)
    return scene_of(
        [
            sphere(place, size, kind)
            if number % 2
            else quad(place, [size, 0, 0], [0, 0, 2 * size], kind)
            for number, (place, size, kind) in enumerate(zip(places, sizes, kinds, strict=True))
        ],
        LAMPS,
    )


def weights(rows: Array, origin: Array) -> Array:
    """The weights of clusters or parts at a point, float64: flux over squared distance."""
    away2 = ((rows["center"].astype(np.float64) - origin) ** 2).sum(axis=-1)
    weight: Array = rows["probability"] / np.maximum(away2, rows["reach2"])
    return weight


def chances(scene: Scene, origin: Array) -> Array:
    """Each lamp's chance at a point: its cluster and part by flux and nearness, then by flux."""
    rows = packed(scene)
    clusters, parts = rows["Cluster"][:MOST_NEAR], parts_of(rows)
    chance = weights(clusters, origin)[:, None] / weights(clusters, origin).sum()
    chance = chance * weights(parts, origin) / weights(parts, origin).sum(axis=1, keepdims=True)
    place = (rows["Light"]["alias"] >> 16) - MOST_NEAR
    each: Array = chance.ravel()[place] * rows["Light"]["share"]
    return each


def parts_of(rows: dict[str, Array]) -> Array:
    """The parts of each cluster, (MOST_NEAR, PARTS) rows."""
    return rows["Cluster"][MOST_NEAR:].reshape(MOST_NEAR, PARTS)


# --- groups ----------------------------------------------------------------------------------


@pytest.mark.parametrize("count", [1, 2, MOST_NEAR, *COUNTS])
def test_each_lamp_is_in_one_group_and_there_are_as_many_as_may_be(count: int) -> None:
    random = np.random.default_rng(count)
    groups = grouped(random.normal(size=(count, 3)), random.uniform(size=count), MOST_NEAR)
    assert len(groups) == min(count, MOST_NEAR)
    assert all(len(group) for group in groups)
    assert sorted(np.concatenate(groups)) == list(range(count))


def test_lamps_far_apart_are_in_groups_of_their_own() -> None:
    """Places around 32 corners, however many lamps each has and however bright they are."""
    random = np.random.default_rng(1)
    corner = np.stack(np.meshgrid([0, 9], [0, 9], np.arange(8) * 9), axis=-1).reshape(-1, 3)
    home = np.concatenate([np.arange(MOST_NEAR), random.integers(0, MOST_NEAR, 300)])
    place = corner[home] + random.uniform(-1, 1, (len(home), 3))
    groups = grouped(place, random.uniform(0.5, 1, len(home)), MOST_NEAR)
    assert [len(set(home[group])) for group in groups] == [1] * MOST_NEAR


def test_lamps_in_one_place_are_grouped_somehow() -> None:
    groups = grouped(np.zeros((100, 3)), np.ones(100), MOST_NEAR)
    assert sorted(np.concatenate(groups)) == list(range(100))


def test_the_order_of_lamps_that_are_few_stays_that_of_the_scene() -> None:
    rows = packed(mixed(MOST_NEAR))
    spheres = MOST_NEAR // 2
    assert rows["Light"]["shape"].tolist() == list(range(MOST_NEAR))
    assert rows["Cluster"]["shape"].tolist() == list(range(MOST_NEAR))
    assert rows["Sphere"]["light"].tolist() == list(range(spheres))


@pytest.mark.parametrize("count", COUNTS)
def test_clusters_and_their_parts_hold_all_lamps_with_their_flux(count: int) -> None:
    """The parts of a cluster, one after the other, have its lamps; what is left has no weight."""
    scene = mixed(count)
    rows, shapes = packed(scene), in_order(scene)
    lamps = [shapes[n] for n in rows["Light"]["shape"]]
    emission = [radiance(scene, lamp) for lamp in lamps]
    flux = light_probabilities(list(bodies_of(lamps).area * emission))
    assert sorted(rows["Light"]["shape"]) == list(range(count))
    end = 0
    for cluster, parts in zip(rows["Cluster"], parts_of(rows), strict=False):
        held = parts[parts["count"] > 0]
        assert (cluster["first"], held["first"][0]) == (end, end)
        assert np.all(np.diff(held["first"]) == held["count"][:-1])
        assert cluster["count"] == held["count"].sum() >= len(held)
        end += cluster["count"]
        for row in (cluster, *held):
            own = flux[row["first"] :][: row["count"]].sum()
            assert row["probability"] == pytest.approx(own, rel=1e-5)
            assert (row["shape"] >= 0) == (row["count"] == 1)
        assert np.all(parts["probability"][len(held) :] == 0)
    assert end == count


@pytest.mark.parametrize("count", COUNTS)
def test_tables_choose_by_flux_within_a_part(count: int) -> None:
    """The tables stay within the part."""
    rows = packed(mixed(count))
    for number, part in enumerate(rows["Cluster"]):
        if number < MOST_NEAR or not part["count"]:
            continue
        members = rows["Light"][part["first"] :][: part["count"]]
        assert np.all(members["alias"] >> 16 == number)
        keep, alias = members["keep"].astype(np.float64), members["alias"] % 2**16 - part["first"]
        chosen = (keep + np.bincount(alias, 1 - keep, len(keep))) / len(keep)
        assert_allclose(chosen, members["share"], rtol=1e-4)


@pytest.mark.parametrize("count", COUNTS)
def test_the_reach_of_a_cluster_is_the_mean_squared_distance_of_its_light(count: int) -> None:
    """Taken from points all over its lamps: balls of one radius, of one brightness."""
    random = np.random.default_rng(count)
    places = random.uniform(-2, 2, (count, 3))
    rows = packed(scene_of([sphere(place, 0.3, "lamp") for place in places], LAMPS))
    surface = random.normal(size=(4096, 3))
    surface *= 0.3 / np.linalg.norm(surface, axis=1, keepdims=True)
    for cluster in rows["Cluster"][: MOST_NEAR + PARTS]:
        if not cluster["count"]:
            continue
        shapes = rows["Light"]["shape"][cluster["first"] :][: cluster["count"]]
        points = (places[shapes][:, None] + surface).reshape(-1, 3)
        assert_allclose(points.mean(axis=0), cluster["center"], atol=0.02)
        reach2 = ((points - cluster["center"]) ** 2).sum(axis=1).mean()
        assert reach2 == pytest.approx(cluster["reach2"], rel=0.02, abs=0.01)


def test_a_moved_camera_does_not_group_lamps_again() -> None:
    scene = mixed(100)
    camera = scene.camera.model_copy(update={"position": (0.3, 7.1, -2.9)})
    rows, moved = packed(scene), packed(scene.model_copy(update={"camera": camera}))
    assert np.all(rows["Light"]["shape"] == moved["Light"]["shape"])
    shift = (rows["Cluster"]["center"] - moved["Cluster"]["center"])[:MOST_NEAR]
    assert_allclose(shift, np.tile(camera.position, (MOST_NEAR, 1)), atol=1e-5)


# --- the choice --------------------------------------------------------------------------------


@pytest.mark.slow_cases("999")
@pytest.mark.parametrize("count", COUNTS)
def test_densities_are_the_chances_of_clusters_and_of_lamps_in_them(
    call_glsl: CallGlsl, count: int
) -> None:
    """This holds at random points, so the densities sum up to 1."""
    scene = mixed(count)
    for place in np.random.default_rng(count).uniform(-3, 3, (4, 3)):
        origin = np.tile(place, (count, 1)).astype(np.float32)
        found = call_glsl(
            "choice_pdf(index, from, total)",
            setup=CHOICE,
            scene=scene,
            origin=origin,
            index=np.arange(count),
        )
        assert_allclose(found, chances(scene, origin[0].astype(np.float64)), rtol=1e-4)
        assert found.sum(dtype=np.float64) == pytest.approx(1, abs=1e-5)


@pytest.mark.slow_cases("999")
@pytest.mark.parametrize("count", COUNTS)
def test_a_lamp_is_chosen_as_often_as_its_density_says(call_glsl: CallGlsl, count: int) -> None:
    """Near the lamps and far from them; the chance of a false alarm is that of `alarms`."""
    scene, random = mixed(count), np.random.default_rng(count)
    for place in ([0.1, 0.2, 0.3], [-1.9, 1.9, 1.8], [30.0, -40.0, 10.0]):
        u = np.floor(random.uniform(size=(DRAWS, 3)) * 2**24) / 2**24
        origin = np.tile(place, (DRAWS, 1))
        args = {"setup": CHOICE, "scene": scene, "origin": origin, "u": u}
        index = call_glsl("choose_light(from, total, u)", "int", **args)
        counts = np.bincount(index, minlength=count)
        assert_fits(counts, DRAWS * chances(scene, np.array(place, np.float32)))


@pytest.mark.slow
def test_the_choice_stays_within_the_lamps_at_the_ends(call_glsl: CallGlsl) -> None:
    ends = np.concatenate([np.arange(12) / 12, [BELOW_ONE, 2.0**-24]])
    u = np.array(list(product(ends, repeat=3)))
    args = {"setup": CHOICE, "scene": mixed(999), "origin": np.zeros((len(u), 3)), "u": u}
    index = call_glsl("choose_light(from, total, u)", "int", **args)
    assert index.min() == 0
    assert index.max() == 998


def test_a_lamp_that_is_a_cluster_is_not_chosen_where_it_was_just_left(
    call_glsl: CallGlsl,
) -> None:
    """One lamp is far from 99 others; among them its choice would be wasted."""
    random = np.random.default_rng(1)
    places = [[50, 0, 0], *random.uniform(-1, 1, (99, 3))]
    scene = scene_of([sphere(place, 0.01, "lamp") for place in places], LAMPS)
    u = random.uniform(size=(2**12, 3))
    origin = np.tile([49.9, 0, 0], (len(u), 1))
    for left, share in ((0, 0.0), (1, 0.99)):
        setup = f"{FROM} from.origin_shape = {left}; float total = total_weight(from);"
        args = {"setup": setup, "scene": scene, "origin": origin, "u": u}
        shape = call_glsl("light_at(choose_light(from, total, u)).shape", "int", **args)
        assert np.mean(shape == 0) == pytest.approx(share, abs=0.01)


@pytest.mark.slow
@pytest.mark.parametrize("count", [MOST_NEAR, 2 * MOST_NEAR, 300])
def test_many_lamps_bring_the_light_that_scattering_finds(context: Context, count: int) -> None:
    """Small balls under a ceiling; measured: errors of 0.03, 0.03 and 0.05."""
    random = np.random.default_rng(count)
    places = random.uniform([-2, 0.6, -4], [2, 0.9, -2], (count, 3))
    lamps = [sphere(place, 2 / count**0.5 / 10, "lamp") for place in places]
    walls = [plane([0, y, 0], [0, -y, 0], "matte") for y in (-1, 1)]
    scene = scene_of([*walls, plane([0, 0, -4.5], [0, 0, 1], "matte"), *lamps], LAMPS)
    size = {"width": 32, "height": 32, "bounces": 3}
    by_choice = rendered(scene, context, 1024, seed=1, **size)
    by_scattering = rendered(scene, context, 1024, seed=2, method="naive", **size)
    assert_agree(by_choice, by_scattering, within=0.05)
    assert by_choice.error is not None
    assert by_choice.error < 0.07


@pytest.mark.slow
@pytest.mark.parametrize("lamps_in_all", [8, 64])
def test_a_corridor_needs_a_third_of_the_samples(
    context: Context, monkeypatch: pytest.MonkeyPatch, lamps_in_all: int
) -> None:
    """A choice by flux alone is the baseline: measured 0.55 of its error, with 64 lamps 0.61."""
    walls = [plane([0, y, 0], [0, -y, 0], "matte") for y in (-1, 1)]
    walls += [plane([x, 0, 0], [-x, 0, 0], "matte") for x in (-1, 1)]
    step = 16 / lamps_in_all
    balls = [sphere([0, 0.8, -1 - step * i], 0.1 * step / 2, "lamp") for i in range(lamps_in_all)]
    corridor = scene_of([*walls, *balls], LAMPS)
    near = rendered(corridor, context, 64, bounces=2)
    for module in (facts, lights):
        monkeypatch.setattr(module, "MOST_NEAR", 1)
    monkeypatch.setattr(lights, "grouped", lambda place, weight, most: [np.arange(len(weight))])
    by_table = rendered(corridor, context, 64, bounces=2)
    assert near.error is not None
    assert by_table.error is not None
    assert near.error < 0.65 * by_table.error
