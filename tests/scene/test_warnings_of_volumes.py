"""Glass meshes with rounded edges, and priorities that change nothing, are reported."""

from itertools import combinations
from typing import Any

import numpy as np
import pytest

from glrt.scene.animation.tracks import Animation
from glrt.scene.scene import Scene
from tests.scene.test_warnings import MATERIALS, told
from tests.support.builders import scene_of, sphere
from tests.support.media import filled, medium
from tests.support.meshes import box as box_of_triangles
from tests.support.meshes import mesh

WHITE = {"color": [1, 1, 1]}
BLOCK = box_of_triangles([-1, -1, -6], [1, 1, -4])


def icosahedron() -> tuple[Any, Any]:
    """A coarse stand-in for a ball: its normals are 37 degrees off those of its triangles."""
    golden = (1 + 5**0.5) / 2
    points = [
        p for a in (-1, 1) for b in (-golden, golden) for p in ((0, a, b), (a, b, 0), (b, 0, a))
    ]
    corners = np.array(points) - [0, 0, 5]
    near = [
        (i, j, k)
        for i, j, k in combinations(range(12), 3)
        if all(np.linalg.norm(corners[a] - corners[b]) < 2.1 for a, b in ((i, j), (j, k), (i, k)))
    ]
    outward = [np.linalg.det(corners[list(three)] - [0, 0, -5]) > 0 for three in near]
    return corners, [it if out else it[::-1] for it, out in zip(near, outward, strict=True)]


@pytest.mark.parametrize(
    ("faces", "more", "material", "warns"),
    [
        (BLOCK, {}, "glass", True),
        (BLOCK, {"smooth": False}, "glass", False),
        (BLOCK, {"smooth": "auto"}, "glass", False),
        (BLOCK, {"hidden": True}, "glass", False),
        (BLOCK, {}, "m", False),
        (BLOCK, {"normals": np.add(BLOCK[0], [0, 0, 5])}, "glass", False),
        (icosahedron(), {}, "glass", False),
    ],
    ids=["cube", "flat", "creased", "hidden", "matte", "own normals", "icosahedron"],
)
def test_glass_whose_sharp_edges_are_rounded_off_is_reported(
    faces: Any, more: Any, material: str, warns: bool
) -> None:
    found = [
        text
        for text in told(scene_of([mesh(faces, material, **more)], MATERIALS, background=WHITE))
        if "refracts" in text
    ]
    assert len(found) == warns
    if warns:
        assert "objects[0]: " in found[0]
        assert "on 100 % of its area" in found[0]
        assert 'smooth = "auto"' in found[0]


def with_priorities(*priorities: int | None, media: bool, apart: float = 1.5) -> Scene:
    """Balls in a row, of fog or of glass."""
    balls = [
        {**sphere([apart * n, 0, -9], 1, "glass"), "priority": priority}
        for n, priority in enumerate(priorities)
    ]
    balls = [filled(ball, "fog", "none") for ball in balls] if media else balls
    fog = {"media": {"fog": medium(1.0)}} if media else {}
    materials = {**MATERIALS, "none": {"type": "none"}}
    return scene_of(balls, materials, background=WHITE, **fog)


def test_priorities_that_change_nothing_are_reported() -> None:
    def idle(scene: Scene) -> list[str]:
        return [text for text in told(scene) if "`priority`" in text]

    (text,) = idle(with_priorities(1, None, 2, media=False, apart=3))
    assert text.startswith("objects[0], objects[2]: `priority` of objects counts in scenes with")
    (text,) = idle(with_priorities(1, 2, media=True, apart=3))
    assert text.startswith("objects[0], objects[1]: `priority` changes nothing")
    assert idle(with_priorities(1, 2, media=True)) == []
    assert idle(with_priorities(None, None, media=True, apart=3)) == []
    apart = with_priorities(1, 2, media=True, apart=3)
    moving = apart.model_copy(update={"animation": Animation(frames=2)})
    assert idle(moving) == []
