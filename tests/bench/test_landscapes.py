"""Random scenes with meshes and skies: valid, varied, and the same for a seed."""

import math
from pathlib import Path

import numpy as np
import pytest

from bench.landscapes import landscape, main, sky_image
from bench.peer import Request
from bench.unseen import _about
from glrt.image.sources import load
from glrt.scene.shapes.mesh import Mesh

SEEDS = range(60)


def test_scenes_have_meshes_and_skies_of_each_kind() -> None:
    """Half of them may have meshes; a floor is never under a black sky."""
    found = [landscape(seed) for seed in SEEDS]
    assert 12 <= sum(any(isinstance(it, Mesh) for it in scene.objects) for scene in found) <= 42
    skies = [scene.background for scene in found]
    assert sum(sky.sky is not None for sky in skies) >= 3
    assert sum(sky.image is not None for sky in skies) >= 3
    words = " ".join(_about(scene) for scene in found)
    for word in ("triangles", "clear sky", "image of the sky"):
        assert word in words
    for scene in found:
        planes = sum(it.shape == "plane" for it in scene.objects)
        assert planes == 6 or scene.background.sky or scene.background.image or scene.background.top


@pytest.mark.parametrize("seed", [3, 8])
def test_a_seed_gives_the_same_scene_also_to_other_processes(seed: int) -> None:
    """A request carries meshes and images as files."""
    first, again = landscape(seed), landscape(seed)
    assert first == again
    asked = Request.of(first, width=8, height=8, bounces=2, samples=1, seed=0)
    sent = asked.parsed()
    assert _about(sent) == _about(first)
    meshes = [
        [it.triangles for it in scene.objects if isinstance(it, Mesh)] for scene in (first, sent)
    ]
    for one, other in zip(*meshes, strict=True):
        assert np.array_equal(one.faces, other.faces)
        assert np.allclose(one.vertices, other.vertices, atol=1e-6)


def test_a_scene_is_written_with_its_files(tmp_path: Path) -> None:
    """The file is the scene of the seed."""
    assert main(["8", "-o", str(tmp_path / "scene.toml")]) == 0
    assert _about(load(tmp_path / "scene.toml")) == _about(landscape(8))


def test_the_sun_of_an_image_stands_where_it_should() -> None:
    """One pixel, within the diagonal of one."""
    towards = (0.5, 0.7071, 0.5)
    pixels = sky_image(towards, 1e4)
    row, column, _ = np.unravel_index(np.argmax(pixels), pixels.shape)
    polar = (row + 0.5) * math.pi / pixels.shape[0]
    turn = (column + 0.5) * 2 * math.pi / pixels.shape[1]
    found = np.array(
        [math.sin(polar) * math.cos(turn), math.cos(polar), math.sin(polar) * math.sin(turn)]
    )
    assert found @ np.array(towards) > math.cos(0.08)
    assert np.sort(pixels[..., 0].ravel())[-2] < 1
