"""Whitted's tree: against an independent tree in float64, without noise, and against `whitted`."""

from typing import Any, NamedTuple

import numpy as np
import pytest

from glrt.gpu.context import Context
from glrt.plan.methods import DEPTH_OF_TREE, depth_of
from glrt.plan.plan import prepare
from glrt.rendering.renderer import Renderer
from glrt.rendering.schedule import iterations_per_sample, rounds_of_search
from glrt.scene.scene import Scene
from glrt.settings import Settings, settings_for
from tests.support.builders import lamp, scene_of, sphere
from tests.support.images import same_bits
from tests.support.numerics import Array
from tests.support.renders import assert_agree, rendered

EYE = np.array([0.3, 0.4, 6.0])
SKY = 0.25
NARROW = 1e-3  # degrees: a pixel is one ray


class Ball(NamedTuple):
    """A ball of the scene."""

    center: tuple[float, float, float]
    radius: float
    material: str


BALLS = (
    Ball((0.0, -101.0, 0.0), 100.0, "matte"),  # a floor
    Ball((-0.9, 0.0, 0.0), 1.0, "glass"),
    Ball((1.3, -0.1, -0.6), 0.9, "mirror"),
    Ball((-0.9, 0.0, 0.0), 0.5, "matte"),  # within the glass
    Ball((0.2, 3.5, 1.5), 0.4, "lamp"),
)
ALBEDO, REFLECTANCE, EMISSION, IOR = 0.6, 0.8, 30.0, 1.5
MATERIALS: dict[str, dict[str, Any]] = {
    "matte": {"type": "lambertian", "color": [ALBEDO] * 3},
    "mirror": {"type": "metal", "color": [REFLECTANCE] * 3},
    "glass": {"type": "dielectric", "ior": IOR},
    "lamp": lamp(EMISSION),
}


def scene_towards(target: Any, fov: float = NARROW) -> Scene:
    camera = {"position": EYE.tolist(), "look_at": list(target), "fov": fov}
    balls = [sphere(*ball) for ball in BALLS]
    return scene_of(balls, MATERIALS, camera, background={"color": [SKY] * 3})


# --- the tree in float64 -------------------------------------------------------------------------


def nearest(origin: Array, way: Array, left_out: tuple[str, ...] = ()) -> tuple[float, Ball | None]:
    """Distance of the next surface, and its ball."""
    found: tuple[float, Ball | None] = (np.inf, None)
    for ball in BALLS:
        if ball.material in left_out:
            continue
        away = origin - np.array(ball.center)
        half = float(away @ way)
        inside = half * half - float(away @ away) + ball.radius**2
        if inside <= 0:
            continue
        for t in (-half - np.sqrt(inside), -half + np.sqrt(inside)):
            if 1e-7 < t < found[0]:
                found = t, ball
    return found


def lit(point: Array, normal: Array) -> float:
    """Light of the lamp in its centre, and of a sky that nothing hides, off a matte surface."""
    bulb = BALLS[-1]
    to_lamp = np.array(bulb.center) - point
    distance = float(np.linalg.norm(to_lamp))
    cosine = float(to_lamp @ normal) / distance
    light = ALBEDO * SKY
    is_seen = nearest(point, to_lamp / distance, ("lamp",))[0] > distance
    if cosine > 0 and is_seen:
        light += ALBEDO / np.pi * EMISSION * np.pi * bulb.radius**2 / distance**2 * cosine
    return light


def fresnel(cos_i: float, cos_t: float, n_i: float, n_t: float) -> float:
    s = (n_i * cos_i - n_t * cos_t) / (n_i * cos_i + n_t * cos_t)
    p = (n_t * cos_i - n_i * cos_t) / (n_t * cos_i + n_i * cos_t)
    return (s * s + p * p) / 2


def light(origin: Array, way: Array, depth: int) -> float:
    """Radiance against `way`, by at most `depth` scattering events."""
    distance, ball = nearest(origin, way)
    if ball is None:
        return SKY
    if ball.material == "lamp":
        return EMISSION
    if depth == 0:
        return 0.0
    point = origin + distance * way
    outward = (point - np.array(ball.center)) / ball.radius
    enters = float(way @ outward) < 0
    normal = outward if enters else -outward
    if ball.material == "matte":
        return lit(point, normal)
    cos_i = -float(way @ normal)
    mirrored = way + 2 * cos_i * normal
    if ball.material == "mirror":
        return REFLECTANCE * light(point, mirrored, depth - 1)
    n_i, n_t = (1.0, IOR) if enters else (IOR, 1.0)
    ratio = n_i / n_t
    rest = 1 - ratio**2 * (1 - cos_i**2)
    if rest <= 0:
        return light(point, mirrored, depth - 1)
    cos_t = float(np.sqrt(rest))
    share = fresnel(cos_i, cos_t, n_i, n_t)
    refracted = ratio * way + (ratio * cos_i - cos_t) * normal
    through = light(point, refracted, depth - 1) * ratio**2
    return share * light(point, mirrored, depth - 1) + (1 - share) * through


TARGETS = [
    *[(-0.9 + x, y, 0.0) for x in (-0.85, -0.6, 0.0, 0.55, 0.7) for y in (-0.3, 0.1, 0.6)],
    *[(1.3 + x, -0.1 + y, -0.6) for x in (-0.6, 0.3) for y in (-0.4, 0.5)],
    (0.3, -1.0, 1.0),
    (-0.6, -1.0, 2.0),
]


@pytest.mark.parametrize("bounces", [1, 2, 5, 8])
def test_radiance_is_that_of_a_tree_in_float64(context: Context, bounces: int) -> None:
    """Through glass around a matte ball, over a mirror, and on a floor with shadows."""
    settings: dict[str, Any] = {"width": 8, "height": 8, "method": "whitted_tree"}
    renderer = Renderer(scene_towards(TARGETS[0]), None, context, bounces=bounces, **settings)
    found, truths = [], []
    for target in TARGETS:
        renderer.update(scene_towards(target))
        image = renderer.render(16).image()
        found.append(float(image.radiance.mean(dtype=np.float64)))
        way = np.array(target) - EYE
        truths.append(light(EYE, way / np.linalg.norm(way), bounces))
    renderer.release()
    assert len({round(truth, 3) for truth in truths}) > len(TARGETS) / 2 or bounces == 1
    np.testing.assert_allclose(found, truths, rtol=2e-3)


@pytest.mark.slow
def test_glass_is_without_noise(context: Context) -> None:
    """One ray a pixel: every sample is the same, where `whitted` chooses one of two rays."""
    settings: dict[str, Any] = {"width": 8, "height": 8, "bounces": 6, "roulette": True}
    scene = scene_towards(TARGETS[5])
    tree, chance = (
        rendered(scene, context, 64, method=method, **settings)
        for method in ("whitted_tree", "whitted")
    )
    assert tree.stderr.max() < 1e-5 * tree.radiance.mean()
    assert chance.stderr.max() > 1e-2 * chance.radiance.mean()


@pytest.mark.slow
def test_it_is_the_mean_of_whitted(context: Context) -> None:
    settings: dict[str, Any] = {"width": 24, "height": 16, "bounces": 6}
    scene = scene_towards((0.0, 0.0, 0.0), 40.0)
    tree = rendered(scene, context, 256, method="whitted_tree", **settings)
    chance = rendered(scene, context, 2048, method="whitted", seed=1, **settings)
    assert_agree(tree, chance, within=0.05)


@pytest.mark.slow
def test_a_tree_is_as_deep_as_its_limit(context: Context) -> None:
    settings: dict[str, Any] = {"width": 16, "height": 16, "method": "whitted_tree"}
    scene = scene_towards((-0.9, 0.0, 0.0), 20.0)
    deep, deeper, less = (
        rendered(scene, context, 16, bounces=bounces, **settings).radiance
        for bounces in (DEPTH_OF_TREE, 2 * DEPTH_OF_TREE, DEPTH_OF_TREE - 1)
    )
    assert same_bits(deep, deeper)
    assert not same_bits(deep, less)
    assert depth_of(Settings(method="whitted_tree", bounces=40)) == DEPTH_OF_TREE
    assert depth_of(Settings(method="whitted", bounces=40)) == 40


# --- rounds of loops -----------------------------------------------------------------------------


@pytest.mark.usefixtures("exact_kernels")
@pytest.mark.parametrize("bounces", [2, 5, DEPTH_OF_TREE, 12])
def test_rounds_are_those_of_the_paths_through_glass(bounces: int) -> None:
    """Each of 2^depth paths ends with a shadow ray for each lamp; without glass one path does."""
    with_glass, without = scene_towards((0, 0, 0)), scene_towards((0, 0, 0))
    kept = [shape for shape in without.objects if shape.material != "glass"]
    without = without.model_copy(update={"objects": kept})
    depth = min(bounces, DEPTH_OF_TREE)
    tree = settings_for(with_glass.render, method="whitted_tree", bounces=bounces)
    chain = settings_for(tree, method="whitted")
    plan = prepare(with_glass, tree)
    lamps = sum(plan.facts.lamps.values())
    rays = 2 ** (depth + 1) + 2**depth * lamps
    assert iterations_per_sample(plan) == 1 + rays * (1 + rounds_of_search(plan.facts))
    assert len({iterations_per_sample(prepare(without, way)) for way in (tree, chain)}) == 1
