"""Scenes that `glrt export` writes for Mitsuba look the same when Mitsuba renders the files."""

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from glrt.gpu.context import Context
from glrt.image.image import Image
from glrt.image.sources import load
from glrt.scene.export.companions import Companions
from glrt.scene.export.mitsuba.file import to_mitsuba
from glrt.scene.materials.principled import Principled
from glrt.scene.scene import Scene
from glrt.settings import settings_for
from tests.crosscheck.test_mitsuba import judged, ours
from tests.mitsuba.scenes import glowing, measured, meshes, painted, pictured, solids
from tests.support.system_packages import needs_mitsuba

SAMPLES = 1024
SIZE = {"width": 64, "height": 48}

pytestmark = pytest.mark.slow


def matte(scene: Scene) -> Scene:
    """The scene without facets of dielectrics, which Mitsuba's principled surface has otherwise."""
    changed = {
        name: it.model_copy(update={"specular": 0.0, "metallic": 0.0, "metallic_map": None})
        for name, it in scene.materials.items()
        if isinstance(it, Principled)
    }
    return scene.model_copy(update={"materials": scene.materials | changed})


def shown_by_mitsuba(scene: Scene, folder: Path, bounces: int) -> Image:
    """Mitsuba's picture of the exported file."""
    needs_mitsuba()
    file, picture = folder / "scene.xml", folder / "theirs.exr"
    beside = Companions(file)
    settings = settings_for(scene.render, bounces=bounces, **SIZE)
    file.write_text(to_mitsuba(scene, settings, beside)[0])
    beside.save()
    scene_of_recipe = "cornell"  # the file alone says what is rendered
    line = ["--file", str(file), f"--samples={SAMPLES}", "-o", str(picture)]
    line += [f"--{name}={value}" for name, value in {**SIZE, "bounces": bounces}.items()]
    command = [sys.executable, "-m", "tests.mitsuba", scene_of_recipe, *line]
    done = subprocess.run(command, capture_output=True, text=True, timeout=500)
    assert done.returncode == 0, done.stderr
    return Image.load(picture)


def mirrored(image: Image) -> Image:
    radiance, stderr = (np.ascontiguousarray(it[:, ::-1]) for it in (image.radiance, image.stderr))
    return Image(radiance, stderr, image.samples, image.recipe)


def upside_down(image: Image) -> Image:
    radiance, stderr = (np.ascontiguousarray(it[::-1]) for it in (image.radiance, image.stderr))
    return Image(radiance, stderr, image.samples, image.recipe)


def check(context: Context, scene: Scene, folder: Path, bounces: int) -> None:
    """The exported scene looks the same to Mitsuba, and its picture is the right way round."""
    theirs = shown_by_mitsuba(scene, folder, bounces)
    settings: dict[str, Any] = {**SIZE, "bounces": bounces, "roulette": True}
    picture = ours(context, scene, SAMPLES, **settings)
    found = judged(picture, theirs)
    assert found, str(found)
    assert found.sensitivity.light < 0.05
    for turned in (mirrored, upside_down):
        assert not judged(picture, turned(theirs)), turned.__name__


@pytest.mark.parametrize(
    "name",
    [
        *("cornell", "metals", "weekend", "lens", "sky", "spot", "painted", "fog"),
        *("table", "lamps", "courtyard", "alloys", "smoke"),
    ],
)
def test_bundled_scenes_look_the_same_as_files(context: Context, tmp_path: Path, name: str) -> None:
    check(context, matte(load(name)), tmp_path, 5)


@pytest.mark.parametrize("make", [solids, meshes, glowing, measured])
def test_shapes_and_lamps_look_the_same_as_files(
    context: Context, tmp_path: Path, make: Callable[[], Scene]
) -> None:
    check(context, make(), tmp_path, 4)


def test_an_image_of_the_sky_is_turned_as_it_was(context: Context, tmp_path: Path) -> None:
    check(context, pictured(tmp_path), tmp_path, 3)


@pytest.mark.parametrize("wrap", ["repeat", "mirror", "clamp"])
def test_images_lie_on_meshes_as_they_did(context: Context, tmp_path: Path, wrap: str) -> None:
    check(context, painted(tmp_path, wrap=wrap), tmp_path, 3)
