"""Indirect light from probes: rooms and floors whose light is known in closed form."""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from glrt.gpu.context import Context
from glrt.image.image import Image
from glrt.image.sources import load
from glrt.packing.probes import DISTANCE_MAP, IN_ROW, LIGHT_MAP, even_directions
from glrt.rendering.pipelines import Variant
from glrt.rendering.probe_tracer import UPDATES, ProbeTracer, kept_light
from glrt.rendering.renderer import Renderer
from glrt.scene.scene import Scene
from tests.support.builders import MATTE, box, lamp, plane, quad, room_of_planes, scene_of, sphere
from tests.support.renders import Estimate, assert_mean, rendered, rendering, same
from tests.truths.test_invariance import mixture

Floats = NDArray[Any]

WAY: dict[str, Any] = {"method": "ddgi", "sampler": "sobol", "probes": 2}
GATHERS = {"ddgi": 0, "gather": 1}  # matte surfaces on a path before probes are asked
ROOMS = {"sphere": [sphere([0, 0, 0], 1, "glow")], "planes": room_of_planes("glow")}
OFF_CENTER = {"position": [0.31, -0.17, 0.23], "look_at": [-0.6, 0.5, -1.0], "fov": 90}


def room(name: str, albedo: float, **tables: Any) -> Scene:
    """It shines with 1 everywhere."""
    return scene_of(ROOMS[name], {"glow": lamp(1.0, albedo)}, OFF_CENTER, **tables)


@contextmanager
def probes_of(
    scene: Scene, context: Context, **settings: Any
) -> Iterator[tuple[Renderer, ProbeTracer]]:
    with rendering(scene, context, **{**WAY, **settings}) as renderer:
        tracer = renderer._tracer.probes.tracer
        assert tracer
        with context.gl:
            yield renderer, tracer


def inner(tracer: ProbeTracer, name: str) -> Floats:
    """The inner texels of a map of each probe, (probes, side, side, 3)."""
    side = {"probe_light": LIGHT_MAP, "probe_distances": DISTANCE_MAP}[name]
    texture = tracer.maps[name]
    rows = np.frombuffer(texture.read(), np.float32).reshape(texture.height // side, side, -1, 4)
    tiles = rows.reshape(-1, side, IN_ROW, side, 4).transpose(0, 2, 1, 3, 4)
    tiles = tiles.reshape(-1, side, side, 4)[: tracer.grid.probes]
    return tiles[:, 1:-1, 1:-1, :3]


def directions(side: int) -> Floats:
    """The directions of the inner texels of a map, (side, side, 3)."""
    steps = (np.arange(side) + 0.5) / side * 2 - 1
    y, x = np.meshgrid(steps, steps, indexing="ij")
    z = 1 - np.abs(x) - np.abs(y)
    lower = z < 0
    u = np.where(lower, (1 - np.abs(y)) * np.where(x >= 0, 1, -1), x)
    v = np.where(lower, (1 - np.abs(x)) * np.where(y >= 0, 1, -1), y)
    found = np.stack([u, v, z], axis=-1)
    return np.asarray(found / np.linalg.norm(found, axis=-1, keepdims=True))


# --- pictures ---------------------------------------------------------------------------------


@pytest.mark.slow_cases("gather-*")
@pytest.mark.parametrize(
    ("method", "bounces"), [("ddgi", 0), ("ddgi", 1), ("gather", 0), ("gather", 1), ("gather", 2)]
)
def test_light_that_probes_do_not_bring_is_that_of_mis_to_the_bit(
    context: Context, method: str, bounces: int
) -> None:
    ways = {"bounces": bounces, "sampler": "sobol"}
    probes = rendered(mixture(), context, 16, **{**WAY, **ways, "method": method})
    assert same(probes, rendered(mixture(), context, 16, method="mis", **ways))


@pytest.mark.slow_cases("sphere-gather")
@pytest.mark.parametrize("method", GATHERS)
@pytest.mark.parametrize("name", ROOMS)
def test_as_many_bounces_as_probes_bring_one_of_are_exact_in_a_closed_room(
    context: Context, name: str, method: str
) -> None:
    """1 + a + a^2; a gather takes a^3 from them."""
    bounces = 2 + GATHERS[method]
    image = rendered(room(name, 0.5), context, 16, **{**WAY, "method": method}, bounces=bounces)
    np.testing.assert_allclose(image.radiance, 2 - 0.5**bounces, rtol=1e-5)


@pytest.mark.parametrize("method", GATHERS)
@pytest.mark.parametrize("albedo", [0.5, 0.95])
@pytest.mark.parametrize("name", ROOMS)
def test_a_closed_room_has_the_light_of_all_bounces(
    context: Context, name: str, albedo: float, method: str
) -> None:
    """1 / (1 - a), less what does not come in so many updates: light of each is a (1 + E)."""
    bounces = 3 + GATHERS[method]
    image = rendered(room(name, albedo), context, 16, **{**WAY, "method": method}, bounces=bounces)
    held = 0.0  # by the probes, as radiance
    for update in range(UPDATES):
        kept = kept_light(update)
        held = kept * held + (1 - kept) * albedo * (1 + held)
    expected = 1 + albedo + albedo * held
    if method == "gather":
        expected = 1 + albedo * expected
    np.testing.assert_allclose(image.radiance, expected, rtol=1e-4)
    np.testing.assert_allclose(image.radiance, 1 / (1 - albedo), rtol=0.01)


def test_a_matte_surface_in_a_mirror_is_the_first_one_of_a_gather(context: Context) -> None:
    """After the mirror two surfaces are traced, so that the third bounce is the last one."""
    mirror = quad([-9, -9, -0.5], [18, 0, 0], [0, 18, 0], "mirror")
    things = [*room_of_planes("wall"), sphere([0.2, 0.4, 0.5], 0.2, "lamp"), mirror]
    materials = {"wall": MATTE, "lamp": lamp(4.0), "mirror": {"type": "metal", "color": [1, 1, 1]}}
    scene = scene_of(things, materials, {"position": [0, 0, 0], "look_at": [0, 0, -1], "fov": 60})
    ways = {**WAY, "bounces": 3}
    expected = rendered(scene, context, 16, **{**ways, "method": "mis"})
    assert same(rendered(scene, context, 16, **{**ways, "method": "gather"}), expected)
    assert not same(rendered(scene, context, 16, **ways), expected)


@pytest.mark.slow
@pytest.mark.parametrize("method", GATHERS)
def test_a_scene_scaled_by_a_power_of_two_keeps_its_bits(context: Context, method: str) -> None:
    way = {**WAY, "method": method}
    expected = rendered(mixture(), context, 16, **way)
    for power in (-9, -1, 4, 10):
        assert same(rendered(mixture(2.0**power), context, 16, **way), expected), power


def test_the_picture_of_other_samples_at_once_has_the_same_bits(context: Context) -> None:
    """Sets of probes hang on their number alone."""
    scene = load("methods/diffuse")
    with rendering(scene, context, **WAY) as renderer:
        expected = renderer.render(48).image()
        renderer.restart()
        for samples in (5, 11, 20, 12):
            renderer.step(samples)
        assert same(renderer.image(), expected)
        renderer.update(seed=1)
        assert not same(renderer.render(48).image(), expected)
        renderer.update(seed=0)
        assert same(renderer.render(48).image(), expected)


@pytest.mark.slow
def test_the_error_reports_the_noise_of_probes(context: Context) -> None:
    """Over seeds, pictures vary as each of them says: probes too, which all of its pixels share."""
    found: list[Image] = []
    with rendering(load("methods/diffuse"), context, **{**WAY, "width": 8, "height": 8}) as it:
        for seed in range(64):
            it.update(seed=seed)
            found.append(it.render(64).image())
    told = np.mean([np.square(image.stderr) for image in found], axis=0)
    spread = np.var([image.radiance for image in found], axis=0, ddof=1)
    assert 0.8 < spread.sum() / told.sum() < 1.25
    means = [image.radiance.mean() for image in found]
    alone = np.sqrt(np.square([image.stderr for image in found]).sum(axis=(1, 2, 3))).mean()
    assert np.std(means) < 4 * alone / found[0].radiance.size  # pixels share a part of their noise


# --- maps -------------------------------------------------------------------------------------


def test_irradiance_over_a_floor_is_a_half_space(context: Context) -> None:
    """Under a white sky, which probes leave out, a floor of albedo a: E = pi a (1 - n.y) / 2."""
    scene = scene_of(
        [plane([0, 0, 0], [0, 1, 0], "floor")],
        {"floor": MATTE},
        {"position": [0, 1, 0]},
        background={"color": [1.0, 1.0, 1.0]},
        probes={"min": [-1, 0.5, -1], "max": [1, 2.5, 1]},
    )
    with probes_of(scene, context, bounces=2) as (_, tracer):
        sets = []
        for number in range(64):
            tracer.update(number, kept=0.0)
            sets.append(inner(tracer, "probe_light").mean(axis=0))
    truth = np.pi * 0.5 * (1 - directions(LIGHT_MAP - 2)[..., 1:2]) / 2 * np.ones(3)
    found = np.array(sets, np.float64)
    estimate = Estimate(found.mean(axis=0), found.std(axis=0, ddof=1) / np.sqrt(len(found)))
    seen = truth[..., 0] > 0.2  # where a few rays alone see the floor, they are not normal
    assert_mean(Estimate(estimate.mean[seen], estimate.stderr[seen]), truth[seen], within=0.2)
    np.testing.assert_allclose(estimate.mean, truth, atol=0.03)


def test_distances_in_a_ball_are_those_of_its_chords(context: Context) -> None:
    """Means by cos^50 about each direction, of lengths up to 1.5 diagonals of a cell."""
    scene = room("sphere", 0.5, probes={"min": [-0.75] * 3, "max": [0.75] * 3})
    with probes_of(scene, context, probes=3, bounces=2) as (_, tracer):
        tracer.update(0)
        places, maps = tracer.grid.places(), inner(tracer, "probe_distances")
        longest = 1.5 * np.linalg.norm(tracer.grid.cell)
    w, rays = directions(DISTANCE_MAP - 2), even_directions(20_000)
    weights = np.maximum(w.reshape(-1, 3) @ rays.T, 0) ** 50
    weights /= weights.sum(axis=1, keepdims=True)
    for place, found in zip(places, maps, strict=True):
        along = rays @ place
        chord = np.minimum(-along + np.sqrt(1 - place @ place + along**2), longest)
        means = np.stack([weights @ chord, weights @ chord**2], axis=1)
        np.testing.assert_allclose(found[..., :2].reshape(-1, 2), means, rtol=0.1, atol=0.03)
        assert (found[..., 1] >= found[..., 0] ** 2 * (1 - 1e-5)).all()
    np.testing.assert_allclose(maps[13][..., :2], 1, rtol=1e-5)  # in the middle of the ball


def test_maps_settle_by_their_hysteresis(context: Context) -> None:
    """After k updates 1 - h^k of a step has come: half after 22.8 with h = 0.97."""
    with probes_of(room("planes", 0.5), context, bounces=2) as (_, tracer):
        for update in range(1, 41):
            tracer.update(0, kept=0.97)
            found = inner(tracer, "probe_light") / (np.pi * 0.5)
            np.testing.assert_allclose(found, 1 - 0.97**update, rtol=1e-3)
            assert (found.mean() >= 0.5) == (update >= 23)


# --- where probes stand -----------------------------------------------------------------------

INSIDE = {"min": [-1.5] * 3, "max": [1.5] * 3}


def placed(context: Context, things: list[dict[str, Any]]) -> Floats:
    """Where 27 probes stand relative to the middles of their cells, and whether they are used."""
    scene = scene_of(things, {"m": MATTE}, {"position": [0, 0, 9]}, probes=INSIDE)
    with probes_of(scene, context, probes=3) as (_, tracer):
        tracer.update(0)
        texture = tracer.maps["probe_places"].read()
    return np.frombuffer(texture, np.float32).reshape(-1, 4)[:27]


def test_a_probe_in_a_small_ball_is_pushed_out_of_it(context: Context) -> None:
    found = placed(context, [sphere([0.1, 0, 0], 0.3, "m")])
    assert (found[:, 3] == 1).all()
    moved = np.linalg.norm(found[:, :3], axis=1) > 0
    assert np.flatnonzero(moved).tolist() == [13]  # the one in the middle
    assert np.linalg.norm(found[13, :3] - [0.1, 0, 0]) > 0.3
    assert np.abs(found[13, :3]).max() <= 0.45


def test_a_probe_deep_in_a_solid_is_of_no_use(context: Context) -> None:
    for thing in (sphere([0, 0, 0], 0.8, "m"), box([-0.7] * 3, [0.7] * 3, "m")):
        found = placed(context, [thing])
        assert found[13, 3] == 0
        assert found[:, 3].sum() == 26


def test_probes_in_a_room_that_is_a_solid_stay(context: Context) -> None:
    """Its inner faces are the walls of the camera's room; from outside probes are pushed in."""
    with probes_of(room("sphere", 0.5), context, probes=3) as (_, tracer):
        tracer.update(0)
        found = np.frombuffer(tracer.maps["probe_places"].read(), np.float32).reshape(-1, 4)[:27]
    away = np.linalg.norm(tracer.grid.places(), axis=1)
    assert (found[away < 0.9] == [0, 0, 0, 1]).all()
    assert (away > 1).sum() == 8
    assert (np.linalg.norm(tracer.grid.places() + found[:, :3], axis=1) < 1).all()
    assert (found[:, 3] == 1).all()


# --- leaks ------------------------------------------------------------------------------------


def divided(thickness: float) -> Scene:
    """A lit room on the left of a sealed dark one, which the camera is in."""
    half = max(thickness, 1e-6) / 2
    wall = box([-half, -1, -1], [half, 1, 1], "m")
    if not thickness:
        wall = quad([0, -1, -1], [0, 2, 0], [0, 0, 2], "m")
    shell = [
        *(quad([-2, y, -1], [4, 0, 0], [0, 0, 2], "m") for y in (-1, 1)),
        *(quad([-2, -1, z], [4, 0, 0], [0, 2, 0], "m") for z in (-1, 1)),
        *(quad([x, -1, -1], [0, 2, 0], [0, 0, 2], "m") for x in (-2, 2)),
    ]
    bulb = sphere([-1, 0.3, 0], 0.2, "lamp")
    eye = {"position": [1.8, 0.5, 0.8], "look_at": [0.3, -1.0, -0.3], "fov": 70}
    probes = {"min": [-2, -1, -1], "max": [2, 1, 1], "counts": [10, 5, 5]}
    return scene_of([*shell, wall, bulb], {"m": MATTE, "lamp": lamp(8.0)}, eye, probes=probes)


def leak(context: Context, thickness: float, **constants: bool) -> float:
    """Mean radiance of the dark room, which should be 0, over that of a floor in the lit one."""
    ways: dict[str, Any] = {**WAY, "probes": 0, "variant": Variant(constants)}
    dark = rendered(divided(thickness), context, 16, **ways).radiance.mean()
    return float(dark)


@pytest.mark.slow
def test_a_dark_room_stays_dark_behind_a_thick_wall(context: Context) -> None:
    thin, thick = leak(context, 0.0), leak(context, 0.3)
    blind = leak(context, 0.0, WITHOUT_VISIBILITY=True)
    print(thin, thick, blind)
    assert thick < thin < blind
    assert blind > 2 * thin
    assert thick < 0.1 * blind
