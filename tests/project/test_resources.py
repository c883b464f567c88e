"""Shaders and scenes are found in a checkout and in an installed package alike."""

import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import glrt
from glrt.core.resources import folder

PACKAGE = Path(glrt.__file__).parent


def test_checkout_keeps_them_next_to_the_package() -> None:
    for name in ("shaders_glsl", "scenes"):
        assert folder(name) == PACKAGE.parent / name
        assert folder(name).is_dir()


@pytest.mark.slow
def test_package_as_a_wheel_installs_it_keeps_them_inside(tmp_path: Path) -> None:
    """Nothing of the checkout is in reach: the copy renders a scene of its own by name."""
    skipped = shutil.ignore_patterns("__pycache__")
    shutil.copytree(PACKAGE, tmp_path / "glrt", ignore=skipped)
    for name in ("shaders_glsl", "scenes"):
        shutil.copytree(folder(name), tmp_path / "glrt" / name, ignore=skipped)
    code = (
        "import sys; sys.path.insert(0, '.'); import glrt, glrt.core.resources as r; "
        "assert str(r.folder('scenes')).startswith(sys.argv[1]), r.folder('scenes'); "
        "glrt.render(glrt.load('cornell'), samples=1, width=8, height=8).save('a.png')"
    )
    told = subprocess.run(
        [sys.executable, "-c", code, str(tmp_path)], capture_output=True, text=True, cwd=tmp_path
    )
    assert told.returncode == 0, told.stderr
    assert (tmp_path / "a.png").exists()
