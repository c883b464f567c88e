"""Scenes by chance: valid, varied, lit, and the same on every machine."""

import hashlib
import json
import math
from functools import cache
from itertools import combinations
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from bench.dice import Dice
from bench.placing import GAP
from bench.scenes import (
    MOST_LAMPS,
    MOST_SHAPES,
    _rounded,
    _turned,
    main,
    random_scene,
    random_tables,
)
from glrt.gpu.context import Context
from glrt.image.sources import load
from glrt.scene.materials.metal import Metal
from glrt.scene.scene import Scene
from glrt.scene.scenefile.toml import parse_scene
from glrt.scene.shapes.box import Box
from glrt.scene.shapes.cylinder import Cylinder
from glrt.scene.shapes.disk import Disk
from glrt.scene.shapes.kinds import KINDS, Shape
from glrt.scene.shapes.mesh import Mesh
from glrt.scene.shapes.plane import Plane
from glrt.scene.shapes.quad import Quad
from glrt.scene.shapes.sphere import Sphere
from glrt.scene.warnings import cautions
from glrt.settings import settings_for
from tests.support.renders import rendered

Floats = NDArray[np.float64]
COS, SIN = math.cos(1.0), math.sin(1.0)

SEEDS = range(200)


@cache
def scene(seed: int) -> Scene:
    return random_scene(seed)


def lamps(scene: Scene) -> list[Shape]:
    return [shape for shape in scene.objects if any(scene.emission_of(shape))]


def points(shape: Shape) -> Floats:
    """The corners of a quad; else the ends along the axes of a ball around it."""
    if not isinstance(shape, Quad):
        axes = np.concatenate([np.eye(3), -np.eye(3)])
        ends: Floats = np.array(shape.middle) + shape.reach * axes
        return ends
    u, v = np.array(shape.edge_u), np.array(shape.edge_v)
    corners: Floats = np.array(shape.corner) + np.array([0 * u, u, v, u + v])
    return corners


def size(shape: Shape) -> float:
    """The radius of a sphere or disk; of a quad, half of its longer edge."""
    if isinstance(shape, Quad):
        return max(math.hypot(*shape.edge_u), math.hypot(*shape.edge_v)) / 2
    return shape.reach


def height_over(plane: Plane, places: Floats) -> float:
    """The height of the lowest of some points, on the side that the plane faces."""
    normal = np.array(plane.normal) / np.linalg.norm(plane.normal)
    return float(((places - plane.point) @ normal).min())


@pytest.mark.slow
def test_nothing_is_degenerate() -> None:
    for seed in SEEDS:
        assert_sound(scene(seed))


def assert_sound(found: Scene) -> None:
    """The camera is free, things do not touch, and no lamp is in a wall or in a ball."""
    assert 3 <= len(found.objects) <= MOST_SHAPES
    assert 1 <= len(lamps(found)) <= MOST_LAMPS
    assert cautions(found, settings_for(found.render)) == []
    eye = np.array(found.camera.position)
    planes = [shape for shape in found.objects if isinstance(shape, Plane)]
    balls = [shape for shape in found.objects if isinstance(shape, Sphere | Box | Cylinder | Disk)]
    assert min((height_over(plane, eye[None]) for plane in planes), default=1.0) > 0.2
    for lamp in lamps(found):
        for plane in planes:
            assert height_over(plane, points(lamp)) > 0.9 * GAP
        assert points(lamp)[:, 1].min() > 0
    for ball in balls:
        assert math.dist(ball.middle, found.camera.position) > 2 * ball.reach
        assert all(height_over(plane, points(ball)) > -1e-4 for plane in planes)
    for a, b in combinations(balls, 2):
        assert math.dist(a.middle, b.middle) > a.reach + b.reach


def test_the_first_ball_is_in_view() -> None:
    for seed in SEEDS:
        camera = scene(seed).camera
        ball = next(shape for shape in scene(seed).objects if isinstance(shape, Sphere))
        there, view = np.subtract(ball.center, camera.position), np.array(camera.view)
        cosine = there @ view / (np.linalg.norm(there) * np.linalg.norm(view))
        assert math.degrees(math.acos(min(1.0, cosine))) < camera.fov / 2


def test_every_kind_of_thing_occurs() -> None:
    scenes = [scene(seed) for seed in SEEDS]
    used = {s.materials[shape.material].type for s in scenes for shape in s.objects}
    assert used == {"lambertian", "metal", "dielectric", "light"}
    metals = [m for s in scenes for m in s.materials.values() if isinstance(m, Metal)]
    assert {metal.roughness == 0 for metal in metals} == {True, False}
    assert {type(lamp) for s in scenes for lamp in lamps(s)} == {Sphere, Quad, Disk}
    assert {type(shape) for s in scenes for shape in s.objects} == {*KINDS.values()} - {Mesh}
    tubes = [shape for s in scenes for shape in s.objects if isinstance(shape, Cylinder)]
    assert {tube.capped for tube in tubes} == {True, False}
    floors = {type(s.objects[0]) for s in scenes}
    assert floors == {Plane, Quad}
    planes = {sum(isinstance(shape, Plane) for shape in s.objects) for s in scenes}
    assert planes == {0, 1, 2, 6}
    open_ones = [s for s in scenes if sum(isinstance(shape, Plane) for shape in s.objects) < 6]
    assert 70 < len(open_ones) < 130
    assert {any(map(any, s.background.gradient)) for s in open_ones} == {True, False}


def test_a_third_has_a_lens() -> None:
    lenses = [scene(seed).camera for seed in SEEDS if scene(seed).camera.defocus_angle]
    assert 0.23 < len(lenses) / len(SEEDS) < 0.43
    assert {camera.focus_distance is None for camera in lenses} == {True, False}


def test_numbers_and_sizes_spread() -> None:
    scenes = [scene(seed) for seed in SEEDS]
    shapes, numbers = [len(s.objects) for s in scenes], [len(lamps(s)) for s in scenes]
    assert min(shapes) <= 5
    assert max(shapes) >= 50
    assert (min(numbers), max(numbers)) == (1, MOST_LAMPS)
    sizes = [size(lamp) for s in scenes for lamp in lamps(s)]
    assert max(sizes) / min(sizes) > 100


def test_a_seed_is_one_scene_on_every_machine() -> None:
    assert random_scene(7) == random_scene(7) != random_scene(8)
    text = json.dumps(random_tables(7), sort_keys=True)
    assert hashlib.sha256(text.encode()).hexdigest()[:16] == "194d689253c7055d"


def test_a_scene_turns_as_a_whole() -> None:
    """Rays turned with it meet its shapes at the same distances."""
    tables = next(t for t in map(random_tables, SEEDS) if {"box", "cylinder", "disk"} <= kinds(t))
    before = [shape for shape in parse_scene(tables, "before").objects if type(shape) is not Plane]
    turned = parse_scene(_rounded(_turned(arrays(tables), 1.0)), "turned")
    after = [shape for shape in turned.objects if type(shape) is not Plane]
    turn = np.array([[COS, 0, SIN], [0, 1, 0], [-SIN, 0, COS]])
    draw = np.random.default_rng(0)
    for one, other in zip(before, after, strict=True):
        eye = np.array(one.middle) + 3 * one.reach
        aims = np.array(one.middle) + one.reach * draw.uniform(-0.5, 0.5, (50, 3)) - eye
        for aim in aims / np.linalg.norm(aims, axis=1)[:, None]:
            with np.errstate(all="ignore"):
                there = type(one).distances(np.array([one.row]), eye, aim)
                back = type(other).distances(np.array([other.row]), turn @ eye, turn @ aim)
            assert np.isfinite(there) == np.isfinite(back)
            assert not np.isfinite(there) or abs(there - back) < 2e-3 * one.reach + 1e-3


def kinds(tables: dict[str, Any]) -> set[str]:
    return {item["shape"] for item in tables["objects"]}


def arrays(value: Any) -> Any:
    """Tables with lists of numbers as arrays, as they are before they are turned."""
    if isinstance(value, dict):
        return {key: arrays(item) for key, item in value.items()}
    if isinstance(value, list) and value and isinstance(value[0], dict):
        return [arrays(item) for item in value]
    return np.array(value) if isinstance(value, list) else value


def test_counts_have_both_ends() -> None:
    dice = Dice(0)
    assert {dice.count(1, 5) for _ in range(200)} == {1, 2, 3, 4, 5}
    assert {dice.count(1, 1) for _ in range(9)} == {1}


@pytest.mark.slow_cases("1")
@pytest.mark.slow_cases("2")
@pytest.mark.parametrize("seed", [0, 1, 2])
def test_a_picture_is_lit(context: Context, seed: int) -> None:
    image = rendered(scene(seed), context, 16, width=16, height=12)
    assert 0.02 < image.radiance.mean() < 20


def test_a_file_is_the_same_scene(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "drawn.toml"
    assert main(["3", "-o", str(file)]) == 0
    assert load(file) == scene(3)
    assert main(["3"]) == 0
    assert capsys.readouterr().out == file.read_text()
    assert main(["3", "-o", str(tmp_path / "nowhere" / "drawn.toml")]) == 4
    assert "Cannot write" in capsys.readouterr().err
