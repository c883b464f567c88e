"""The kernel of a frame follows from what moves in its series, and from the work of a frame."""

from typing import Any

import pytest

from glrt.rendering.pipelines import Tier
from glrt.series.motion import FAR_MORE, LITTLE, MUCH, Motion, motion_of, tier_of
from glrt.series.series import Series
from glrt.series.sweeps import parse_sweep
from glrt.settings import settings_for
from tests.support.builders import MATTE, box, scene_of, sphere
from tests.support.meshes import icosphere, mesh

THINGS: list[dict[str, Any]] = [
    sphere([0, 0, 0], 1, "white") | {"name": "ball"},
    box([3, 3, 3], [4, 5, 6], "white") | {"name": "box"},
    mesh(icosphere(1), "white") | {"name": "head"},
]
SCENE = scene_of(THINGS, {"white": MATTE})


@pytest.mark.parametrize(
    ("keys", "motion"),
    [
        ([], "none"),
        (["camera.fov", "camera.look_at", "materials.white.color", "lights.lamp"], "none"),
        (["objects.head.translate", "objects.head.rotate"], "none"),
        (["camera.position"], "places"),
        (["camera.time"], "places"),
        (["materials.white.color", "objects.ball.center"], "places"),
        (["objects.ball.radius"], "shapes"),
        (["camera.position", "objects.box.min"], "shapes"),
        (["objects.box.rotate", "camera.position"], "shapes"),
    ],
)
def test_what_moves_follows_from_the_keys(keys: list[str], motion: Motion) -> None:
    assert motion_of(SCENE, [tuple(key.split(".")) for key in keys]) == motion


@pytest.mark.parametrize(
    ("motion", "work", "tier"),
    [
        ("none", LITTLE - 4000, "generic"),
        ("none", LITTLE, "baked"),
        ("places", LITTLE - 4000, "generic"),
        ("places", LITTLE, "placed"),
        ("places", FAR_MORE - 4000, "placed"),
        ("places", FAR_MORE, "baked"),
        ("shapes", MUCH - 4000, "generic"),
        ("shapes", MUCH, "baked"),
    ],
)
def test_the_kernel_follows_from_the_work(motion: Motion, work: int, tier: Tier) -> None:
    balls = scene_of([sphere([i, 0, 0], 0.2, "white") for i in range(4)], {"white": MATTE})
    settings = settings_for(balls.render, width=100, height=10, samples=work // 4000)
    assert tier_of(balls, settings, motion) == tier


def test_where_rays_of_meshes_take_the_time_writing_pays_sooner() -> None:
    settings = settings_for(SCENE.render, width=100, height=10, samples=-(-MUCH // 3000))
    assert tier_of(SCENE, settings, "places") == "baked"


def test_frames_know_what_moves_in_their_series() -> None:
    settings = settings_for(SCENE.render, width=8, height=8)
    sweep = parse_sweep("camera.fov=20:40:3")
    wide = parse_sweep("objects.ball.radius=1:2:3")
    series = [
        Series(SCENE, settings, 4),
        Series(SCENE, settings, None, (sweep,)),
        Series(SCENE, settings, None, (sweep, wide)),
        Series(SCENE, settings),
    ]
    assert [one.still(0).motion for one in series] == ["places", "none", "shapes", "none"]
