"""Real models by two renderers: what is made of a scene, and how pictures are compared."""

import numpy as np
import pytest

import glrt
from bench.real_models import BLOCK, differences, faceted, matte
from glrt.image.image import Image
from glrt.scene.materials.principled import Principled
from glrt.scene.shapes.mesh import Mesh
from tests.support.meshes import icosphere


def scene() -> glrt.Scene:
    """A ball of red metal with a coat."""
    points, faces = icosphere(1)
    paint = glrt.Principled(color=(0.8, 0.2, 0.1), metallic=1.0, roughness=0.3, clearcoat=1.0)
    camera = {"position": [0, 0, 4], "look_at": [0, 0, 0]}
    return glrt.Scene.build(
        camera, [glrt.Mesh(points, faces, material="m")], materials={"m": paint}
    )


def test_a_matte_scene_keeps_its_colours_alone() -> None:
    """A surface that both renderers have."""
    found = matte(scene()).materials["m"]
    assert isinstance(found, Principled)
    assert found.is_matte
    assert found.color == (0.8, 0.2, 0.1)


def test_a_faceted_scene_has_flat_triangles() -> None:
    """Other objects stay."""
    (ball,) = faceted(scene()).objects
    assert isinstance(ball, Mesh)
    assert ball.smooth is False


def test_differences_are_those_of_the_whole_and_of_blocks() -> None:
    """One block of four is twice as bright: the mean by a quarter, the blocks by one half."""
    theirs = np.ones((2 * BLOCK, 2 * BLOCK, 3), np.float32)
    ours = theirs.copy()
    ours[:BLOCK, :BLOCK] = 2
    exact = np.zeros_like(theirs)
    mean, blocks = differences(Image(ours, exact, 1), Image(theirs, exact, 1))
    assert mean == pytest.approx(0.25)
    assert blocks == pytest.approx(0.5)
