"""A third opinion: Mitsuba 3, which shares no line with glrt, shows the same pictures."""

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import glrt
from bench.peer import Peer, Request
from glrt.comparison.result import Comparison
from glrt.comparison.verdict import compare
from glrt.core.errors import RenderError
from glrt.gpu.context import Context
from glrt.image.image import Image
from glrt.image.sources import load
from glrt.scene.scene import Scene, with_lights
from tests.mitsuba.scenes import (
    GLASS_BOX,
    MATERIALS,
    ROUND_LAMP,
    TUBE,
    everything,
    frosted,
    glowing,
    measured,
    meshes,
    painted,
    pictured,
    polished,
    slanted_room,
    solids,
    solids_but,
    sunlit,
)
from tests.support.alarms import ALPHA, book
from tests.support.builders import glass, plane, scene_of, sphere
from tests.support.renders import rendered
from tests.support.system_packages import needs_mitsuba

SMALL = {"width": 48, "height": 48, "bounces": 3, "roulette": False}
SAMPLES = 256


@pytest.fixture(scope="module")
def their_solids(mitsuba: Peer) -> Image:
    """Mitsuba's picture of `solids`."""
    return theirs(mitsuba, solids())


@pytest.fixture(scope="module")
def their_picture(mitsuba: Peer) -> Image:
    """Mitsuba's picture of `everything`."""
    return theirs(mitsuba, everything())


def theirs(mitsuba: Peer, scene: Scene, samples: int = SAMPLES, **changes: Any) -> Image:
    settings = {**SMALL, "samples": samples, "seed": 1, "batches": 64, **changes}
    return mitsuba.render(Request.of(scene, **settings))[0]


def ours(context: Context, scene: Scene, samples: int = SAMPLES, **changes: Any) -> Image:
    return rendered(scene, context, samples, **{**SMALL, "sampler": "independent", **changes})


def judged(ours: Image, theirs: Image) -> Comparison:
    """With equal numbers of samples the noise of both adds up, whatever their methods."""
    book()
    return compare(ours, theirs, alpha=ALPHA, alike=True)


def test_everything_looks_the_same_to_mitsuba(context: Context, their_picture: Image) -> None:
    found = judged(ours(context, everything()), their_picture)
    assert found, str(found)
    assert found.sensitivity.light < 0.02


def test_disks_boxes_and_cylinders_look_the_same_to_mitsuba(
    context: Context, their_solids: Image
) -> None:
    found = judged(ours(context, solids()), their_solids)
    assert found, str(found)
    assert found.sensitivity.light < 0.03


@pytest.mark.parametrize(
    "scene",
    [
        solids_but(GLASS_BOX, rotate=[10, 25, -5]),
        solids_but(TUBE, capped=True),
        solids_but(ROUND_LAMP, radius=0.45),
    ],
    ids=["a box turned", "a tube closed", "a lamp larger"],
)
def test_a_planted_difference_of_solids_is_found(
    context: Context, their_solids: Image, scene: Scene
) -> None:
    found = judged(ours(context, scene), their_solids)
    assert not found, str(found)


@pytest.mark.slow
def test_principled_metals_look_the_same_to_mitsuba(context: Context, mitsuba: Peer) -> None:
    """Where both models agree: Schlick's reflectance over GGX, facets that lose little."""
    found = judged(ours(context, polished()), theirs(mitsuba, polished()))
    assert found, str(found)
    assert found.sensitivity.light < 0.03
    rougher = judged(ours(context, polished(0.6)), theirs(mitsuba, polished()))
    assert not rougher, str(rougher)


@pytest.mark.slow
@pytest.mark.slow_cases("mirror", "clamp")
@pytest.mark.parametrize("wrap", ["repeat", "mirror", "clamp"])
def test_images_lie_on_meshes_as_mitsuba_has_them(
    context: Context, mitsuba: Peer, tmp_path: Path, wrap: str
) -> None:
    scene = painted(tmp_path, wrap=wrap)
    found = judged(ours(context, scene), theirs(mitsuba, scene))
    assert found, str(found)
    other = painted(tmp_path, wrap=wrap, rotation=23)
    assert not judged(ours(context, other), theirs(mitsuba, scene))


@pytest.mark.slow
def test_meshes_look_the_same_to_mitsuba(context: Context, mitsuba: Peer) -> None:
    scene = meshes()
    picture = theirs(mitsuba, scene)
    found = judged(ours(context, scene), picture)
    assert found, str(found)
    assert found.sensitivity.light < 0.03
    objects = [*scene.objects]
    objects[2] = objects[2].model_copy(update={"translate": (1.15, 0.7, 0.2)})
    turned = scene.model_copy(update={"objects": tuple(objects)})
    assert not judged(ours(context, turned), picture)


@pytest.mark.slow
def test_glowing_surfaces_and_one_sided_lamps_look_the_same_to_mitsuba(
    context: Context, mitsuba: Peer
) -> None:
    picture = theirs(mitsuba, glowing())
    found = judged(ours(context, glowing()), picture)
    assert found, str(found)
    assert found.sensitivity.light < 0.03
    assert not judged(ours(context, glowing(emission_side="both")), picture)
    assert not judged(ours(context, with_lights(glowing(), {"panel": 0.4})), picture)


@pytest.mark.slow
def test_measured_metals_look_the_same_to_mitsuba(context: Context, mitsuba: Peer) -> None:
    picture = theirs(mitsuba, measured())
    found = judged(ours(context, measured()), picture)
    assert found, str(found)
    assert found.sensitivity.light < 0.03
    assert not judged(ours(context, measured("brass")), picture)


@pytest.mark.slow
def test_rough_and_thin_glass_looks_the_same_to_mitsuba(context: Context, mitsuba: Peer) -> None:
    picture = theirs(mitsuba, frosted())
    found = judged(ours(context, frosted()), picture)
    assert found, str(found)
    assert found.sensitivity.light < 0.03
    assert not judged(ours(context, frosted(0.7)), picture)
    assert not judged(ours(context, frosted(ior=2.0)), picture)


@pytest.mark.slow
def test_an_image_of_the_sky_looks_the_same_to_mitsuba(
    context: Context, mitsuba: Peer, tmp_path: Path
) -> None:
    picture = theirs(mitsuba, pictured(tmp_path))
    found = judged(ours(context, pictured(tmp_path)), picture)
    assert found, str(found)
    assert found.sensitivity.light < 0.03
    assert not judged(ours(context, pictured(tmp_path, rotation=40)), picture)
    assert not judged(ours(context, pictured(tmp_path, radiance=300.0)), picture)


@pytest.mark.slow
def test_a_sun_under_a_clear_sky_looks_the_same_to_mitsuba(context: Context, mitsuba: Peer) -> None:
    picture = theirs(mitsuba, sunlit())
    found = judged(ours(context, sunlit()), picture)
    assert found, str(found)
    assert found.sensitivity.light < 0.03
    assert not judged(ours(context, sunlit(azimuth=122.0)), picture)
    assert not judged(ours(context, with_lights(sunlit(), {"sun": 0.93})), picture)


@pytest.mark.slow
def test_the_roughest_metal_looks_the_same_to_mitsuba(context: Context, mitsuba: Peer) -> None:
    """Found if the shadowing of both directions were independent, as in its `roughconductor`."""
    scene = everything(roughness=1.0)
    found = judged(ours(context, scene), theirs(mitsuba, scene))
    assert found, str(found)


def test_the_inside_of_balls_looks_the_same_to_mitsuba(context: Context, mitsuba: Peer) -> None:
    """Seen from within glass: a matte wall and a lamp from inside, and the surface of water."""
    scene = scene_of(
        [
            sphere([0, 0, 0], 5.0, "white"),
            sphere([0, 0.2, 0], 1.0, "glass"),
            sphere([0, 4, -4], 3.0, "bulb"),
            sphere([0, 0.5, -3], 0.7, "rough"),
            plane([0, -1.5, 0], [0, 1, 0], "water"),
        ],
        MATERIALS | {"water": glass(1.33)},
    )
    found = judged(ours(context, scene), theirs(mitsuba, scene))
    assert found, str(found)
    assert found.sensitivity.light < 0.03


@pytest.mark.parametrize(
    ("scene", "settings"),
    [
        (everything(), {"bounces": 4}),
        (everything(), {"bounces": 2}),
        (everything(roughness=0.5**0.5), {}),
        (everything(defocus_angle=4.0), {}),
        (everything(focus_distance=3.0), {}),
        (everything(fov=45.5), {}),
    ],
    ids=["one bounce more", "one less", "alpha = roughness", "half a lens", "focus", "fov"],
)
def test_a_planted_difference_is_found(
    context: Context, their_picture: Image, scene: Scene, settings: dict[str, Any]
) -> None:
    found = judged(ours(context, scene, **settings), their_picture)
    assert not found, str(found)


def test_what_makes_mitsuba_faster_leaves_the_picture(context: Context, mitsuba: Peer) -> None:
    """Planes that end, Mitsuba's own rough metal, and points spread over 64 samples."""
    fast = {"finite": True, "native": True, "sampler": "multijitter"}
    found = theirs(mitsuba, everything(), 1024, **fast)
    assert judged(ours(context, everything()), found).verdict == "same"
    assert not np.array_equal(found.radiance, theirs(mitsuba, everything(), 1024).radiance)


def test_walls_that_end_leave_a_slanted_room_as_bright_to_mitsuba(mitsuba: Peer) -> None:
    """Mitsuba knows a point to a part of the triangle's size: larger ones shade themselves."""
    room = slanted_room()
    found = judged(theirs(mitsuba, room, finite=True), theirs(mitsuba, room))
    assert found, str(found)
    assert found.sensitivity.light < 0.02


def test_points_that_are_spread_come_in_whole_blocks(mitsuba: Peer) -> None:
    with pytest.raises(RenderError, match="multiples of 64 samples"):
        theirs(mitsuba, everything(), 96, sampler="multijitter")


def test_a_lamp_without_its_back_is_found(context: Context, mitsuba: Peer) -> None:
    found = judged(ours(context, everything()), theirs(mitsuba, everything(), one_sided=True))
    assert not found, str(found)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["cornell", "lens", "metals", "sky", "lamps"])
def test_scene_looks_the_same_to_mitsuba(context: Context, mitsuba: Peer, name: str) -> None:
    scene = load(name)
    settings = {"width": 64, "height": 64, "bounces": scene.render.bounces}
    found = judged(ours(context, scene, 2048, **settings), theirs(mitsuba, scene, 2048, **settings))
    assert found.verdict == "same", str(found)


@pytest.mark.slow
def test_the_program_writes_what_compare_reads(tmp_path: Path) -> None:
    """It runs in its slow mode, which needs no LLVM, and from the command line."""
    needs_mitsuba()
    file = tmp_path / "sky.exr"
    line = "sky --width 24 --height 16 --samples 16 --bounces 2 --variant scalar --json -o"
    command = [sys.executable, "-m", "tests.mitsuba", *line.split(), str(file)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=250)
    assert done.returncode == 0, done.stderr
    image = Image.load(file)
    assert image.radiance.shape == (16, 24, 3)
    assert image.samples == json.loads(done.stdout)["samples"] == 16
    assert image.error == json.loads(done.stdout)["error"]
    book()
    assert compare(image, glrt.render(load("sky"), 16, width=24, height=16, bounces=2), ALPHA)
