"""Every route to OpenGL shows the same picture, alone in a process and side by side."""

import os
import shutil
import subprocess
import sys
from ctypes.util import find_library
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from bench.screens import screen
from tests.support.images import same_bits
from tests.support.renders import METHODS
from tests.support.system_packages import needs_osmesa, needs_package

DRAW = """
import sys
import numpy as np
from glrt.gpu.context import open_context
from glrt.image.sources import load
from tests.support.mixed_scene import everything
from tests.support.renders import METHODS, rendered

route, file = sys.argv[1:]
opened = open_context(route)
pictures = {
    f"{name} {method} {seed}": rendered(
        scene, opened, 4, method=method, width=24, height=24, seed=seed
    ).radiance
    for name, scene in (("cornell", load("cornell")), ("everything", everything()))
    for method in METHODS
    for seed in (0, 1)
}
pictures["particles"] = rendered(load("cornell"), opened, 16, caustics="on", width=24).radiance
np.savez(file, is_software=opened.is_software, **pictures)
assert opened.route == route
"""
ROOT = Path(__file__).parents[2]

Pictures = dict[str, NDArray[np.float32]]


def draw(route: str, folder: Path, display: str = "") -> Pictures:
    """Every picture by this route, in a process of its own."""
    script, file = folder / "draw.py", folder / f"{route}.npz"
    script.write_text(DRAW)
    told = subprocess.run(
        [sys.executable, "-W", "error", str(script), route, str(file)],
        capture_output=True,
        text=True,
        timeout=120,
        env={
            **os.environ,
            "DISPLAY": display,
            "PYTHONPATH": os.pathsep.join([str(ROOT), *sys.path]),
        },
    )
    assert told.returncode == 0, told.stderr
    with np.load(file) as drawn:
        return dict(drawn)


@pytest.fixture(scope="module")
def by_egl(tmp_path_factory: pytest.TempPathFactory) -> Pictures:
    needs_package(bool(find_library("EGL")), "libegl1")
    return draw("egl", tmp_path_factory.mktemp("egl"))


@pytest.fixture(scope="module")
def by_osmesa(tmp_path_factory: pytest.TempPathFactory) -> Pictures:
    needs_osmesa()
    return draw("osmesa", tmp_path_factory.mktemp("osmesa"))


@pytest.fixture(scope="module")
def by_window(tmp_path_factory: pytest.TempPathFactory) -> Pictures:
    needs_package(bool(shutil.which("Xvfb")), "xvfb")
    with screen() as display:
        return draw("window", tmp_path_factory.mktemp("window"), display)


def assert_same_pictures(a: Pictures, b: Pictures, name: str) -> None:
    """They are the same to the bit among software drivers; otherwise far below the noise."""
    if a["is_software"] and b["is_software"]:
        assert same_bits(a[f"{name} 0"], b[f"{name} 0"])
    difference = np.square(a[f"{name} 0"] - b[f"{name} 0"]).mean()
    assert difference <= 1e-4 * np.square(a[f"{name} 0"] - b[f"{name} 1"]).mean()


@pytest.mark.slow
@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("scene", ["cornell", "everything"])
def test_egl_and_osmesa_show_the_same_picture(
    by_egl: Pictures, by_osmesa: Pictures, scene: str, method: str
) -> None:
    assert by_osmesa["is_software"]
    assert_same_pictures(by_egl, by_osmesa, f"{scene} {method}")


@pytest.mark.slow_cases("cornell-naive")
@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("scene", ["cornell", "everything"])
def test_hidden_window_shows_the_same_picture(
    by_egl: Pictures, by_window: Pictures, scene: str, method: str
) -> None:
    assert_same_pictures(by_egl, by_window, f"{scene} {method}")


def test_egl_and_osmesa_take_turns_in_one_process(tmp_path: Path) -> None:
    needs_osmesa()
    code = """
from glrt.gpu.context import open_context
from glrt.image.sources import load
from glrt.rendering.renderer import Renderer

def rendered(context):
    return Renderer(load("cornell"), context=context, width=16, height=16)

egl = open_context("egl")
with egl.gl:  # in here OSMesa takes over, unseen by EGL
    pair = rendered(open_context("osmesa")), rendered(egl)
    for samples in (2, 1):
        for renderer in pair:
            renderer.step(samples)
        a, b = (renderer.image().radiance for renderer in pair)
        assert a.any()
        assert (a == b).all()
"""
    told = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, cwd=tmp_path
    )
    assert told.returncode == 0, told.stderr
