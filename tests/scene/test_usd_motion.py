"""Time samples of transforms in USD files: things that move, as an animation."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

from glrt.scene.scene import Scene
from tests.scene.test_usd_meshes import POINTS, same_places
from tests.support.usd_files import layer, left_out, placed, prim, scene_of, square

pytest.importorskip("pxr", reason="usd-core is not installed")

SPAN = "startTimeCode = 1\nendTimeCode = 25\ntimeCodesPerSecond = 24"  # a second


WEDGE = """
    int[] faceVertexCounts = [3]
    int[] faceVertexIndices = [0, 1, 2]
    point3f[] points = [(0, 0, 0), (2, 0, 0), (0, 0, -1)]
    uniform token subdivisionScheme = "none"
"""


def moving(kind: str, name: str, *samples: tuple[float, str]) -> str:
    """A transform by samples: time code and value each."""
    pairs = "\n".join(f"{code}: {value}," for code, value in samples)
    order = f'uniform token[] xformOpOrder = ["xformOp:{name}"]'
    return f"{kind} xformOp:{name}.timeSamples = {{\n{pairs}\n}}\n{order}\n"


def posed(scene: Scene, moment: float) -> Any:
    """Vertices of the model at a moment in seconds."""
    poses = scene.meshes[0].triangles_of_file.poses
    assert poses
    assert poses.names == ("time",)
    return poses.at("time", moment).vertices


SLIDE = moving("double3", "translate", (1, "(0, 0, 0)"), (13, "(4, 0, 0)"), (25, "(4, 2, 0)"))


def test_things_move_between_their_samples(tmp_path: Path) -> None:
    scene = scene_of(tmp_path, layer(square(more=SLIDE), more=SPAN))
    for moment, place in ((0, (0, 0, 0)), (0.25, (2, 0, 0)), (0.5, (4, 0, 0)), (0.75, (4, 1, 0))):
        assert same_places(posed(scene, moment), np.add(POINTS, place))
    assert same_places(posed(scene, 9.0), np.add(POINTS, (4, 2, 0)))
    assert scene.frames == 25
    assert left_out(scene) == "animations, which glrt film shows"


def test_a_whole_turn_between_two_samples_keeps_its_way(tmp_path: Path) -> None:
    turn = moving("float", "rotateY", (1, "0"), (25, "360"))
    scene = scene_of(tmp_path, layer(square(more=turn), more=SPAN))
    corner = posed(scene, 0.0)
    quarter = corner @ [[0, 0, -1], [0, 1, 0], [1, 0, 0]]
    assert_allclose(posed(scene, 0.25), quarter, atol=1e-6)
    assert_allclose(posed(scene, 0.75), -quarter, atol=1e-6)


def test_children_move_with_their_parents_and_upright_in_metres(tmp_path: Path) -> None:
    """In a file of centimetres with z up, mirrored within; what stands still has no keys."""
    corners = np.array([(0, 0, 0), (2, 0, 0), (0, 0, -1)], np.float64)
    inner = prim("Mesh", "wedge", WEDGE + placed(("float3", "scale", "(-1, 1, 1)")))
    still = prim("Xform", "still", square(more=placed(("double3", "translate", "(0, 0, 9)"))))
    text = prim("Xform", "top", SLIDE + inner) + still
    scene = scene_of(tmp_path, layer(text, "Z", 0.01, SPAN))
    for moment, place in ((0.0, (0, 0, 0)), (0.5, (4, 0, 0)), (1.0, (4, 2, 0))):
        parts = [np.add(corners * (-1, 1, 1), place), np.add(POINTS, (0, 0, 9))]
        expected = [0.01 * part @ [[1, 0, 0], [0, 0, -1], [0, 1, 0]] for part in parts]
        assert same_places(posed(scene, moment), *expected)


def test_a_camera_moves(tmp_path: Path) -> None:
    lens = "float focalLength = 50\nfloat2 clippingRange = (0.1, 100)\n"
    way = moving("double3", "translate", (1, "(0, 0, 5)"), (25, "(0, 0, 29)"))
    scene = scene_of(tmp_path, layer(square() + prim("Camera", "eye", lens + way), more=SPAN))
    assert scene.frames == 25
    for frame in (0, 12, 24):
        assert_allclose(scene.at_frame(frame).camera.position, (0, 0, 5 + frame), atol=1e-5)


def test_without_a_range_motion_is_that_of_the_samples(tmp_path: Path) -> None:
    """At 24 time codes a second, which is usual."""
    way = moving("double3", "translate", (10, "(0, 0, 0)"), (34, "(8, 0, 0)"))
    scene = scene_of(tmp_path, layer(square(more=way)))
    assert same_places(posed(scene, 0.5), np.add(POINTS, (4, 0, 0)))


SKEW = (
    "( (1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0), (0, 0, 0, 1) )",
    "( (1, 0, 0, 0), (1, 1, 0, 0), (0, 0, 1, 0), (0, 0, 0, 1) )",
)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (
            square(more=moving("matrix4d", "transform", (1, SKEW[0]), (25, SKEW[1]))),
            "motion that skews or flattens things",
        ),
        (
            square(more=moving("float3", "scale", (1, "(1, 1, 1)"), (25, "(1, 0, 1)"))),
            "motion that skews or flattens things",
        ),
        (
            square() + prim("SphereLight", "bulb", "float inputs:radius = 0.5\n" + SLIDE),
            "motion of lights",
        ),
        (
            square(more='token visibility.timeSamples = {1: "inherited", 2: "invisible"}\n'),
            "changes over time of 'visibility'",
        ),
    ],
    ids=["skewed", "flattened", "light", "visibility"],
)
def test_other_changes_are_left_out_and_reported(tmp_path: Path, text: str, said: str) -> None:
    scene = scene_of(tmp_path, layer(text, more=SPAN))
    assert said in left_out(scene)
    assert scene.frames == 1


def test_endless_motion_is_left_out(tmp_path: Path) -> None:
    span = SPAN.replace("25", "20000")
    scene = scene_of(tmp_path, layer(square(more=SLIDE), more=span))
    assert "motion over more than 10,000 time codes" in left_out(scene)
    assert scene.meshes[0].triangles_of_file.poses is None
