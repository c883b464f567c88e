"""The distribution: a wheel and an sdist, with all that glrt needs to run and nothing else."""

import re
import subprocess
import sys
import tarfile
import tomllib
import zipfile
from email.message import Message
from email.parser import HeaderParser
from pathlib import Path

import pytest

from glrt.core.version import VERSION

ROOT = Path(__file__).parents[2]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
FOLDERS = ("glrt", "shaders_glsl", "scenes")
SUFFIXES = {
    "glrt": {".py", ".typed", ".npz", ".txt", ".html", ".js", ".css"},
    "shaders_glsl": {".glsl", ".comp", ".vert", ".frag"},
    "scenes": {".toml", ".ply", ".glb", ".npy", ".jpg"},
}
EXTRA = re.compile(r"'(?:glrt|\.)\[(\w+)\]")  # as in `pip install '.[view]'`
INFO = f"glrt-{VERSION}.dist-info"
LICENSES = {
    f"{INFO}/licenses/{name}" for name in ("LICENSE", "glrt/scene/lights/clear_sky_license.txt")
}


def sources() -> set[str]:
    """The files of the repository that glrt needs to run."""
    listed = subprocess.run(
        ["git", "ls-files", "-co", "--exclude-standard", *FOLDERS],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=True,
    )
    return {name for name in listed.stdout.splitlines() if (ROOT / name).exists()}


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with both, built without network by what the environment has."""
    folder = tmp_path_factory.mktemp("dist")
    code = (
        "import sys; from hatchling import build as b; "
        "b.build_wheel(sys.argv[1]); b.build_sdist(sys.argv[1])"
    )
    subprocess.run([sys.executable, "-c", code, str(folder)], cwd=ROOT, check=True)
    return folder


@pytest.fixture(scope="module")
def wheel(built: Path) -> zipfile.ZipFile:
    (path,) = built.glob("*.whl")
    assert path.name == f"glrt-{VERSION}-py3-none-any.whl"
    return zipfile.ZipFile(path)


@pytest.fixture(scope="module")
def metadata(wheel: zipfile.ZipFile) -> Message:
    return HeaderParser().parsestr(wheel.read(f"{INFO}/METADATA").decode())


def test_what_glrt_needs_is_code_shaders_and_scenes() -> None:
    for name in sources():
        top, suffix = name.split("/")[0], Path(name).suffix
        assert suffix in SUFFIXES[top], name


def test_the_wheel_holds_code_shaders_and_scenes_and_nothing_else(wheel: zipfile.ZipFile) -> None:
    inside = {name if name.startswith("glrt/") else f"glrt/{name}" for name in sources()}
    about = {f"{INFO}/{name}" for name in ("METADATA", "WHEEL", "RECORD", "entry_points.txt")}
    assert set(wheel.namelist()) == inside | about | LICENSES
    assert "glrt/py.typed" in inside
    assert {"glrt/shaders_glsl/trace.comp", "glrt/scenes/cornell.toml"} <= inside


def test_the_sdist_holds_what_the_wheel_is_built_from(built: Path) -> None:
    (path,) = built.glob("*.tar.gz")
    about = {"pyproject.toml", "README.md", "CHANGELOG.md", "LICENSE", "PKG-INFO", ".gitignore"}
    with tarfile.open(path) as archive:
        assert set(archive.getnames()) == {f"glrt-{VERSION}/{name}" for name in sources() | about}


def test_extras_are_what_exist(metadata: Message) -> None:
    texts = [ROOT / "README.md", *(ROOT / "docs").rglob("*.md"), *(ROOT / "glrt").rglob("*.py")]
    advised = {name for file in texts for name in EXTRA.findall(file.read_text())}
    assert {"view", "chart"} <= advised <= set(metadata.get_all("Provides-Extra", []))
    assert metadata["Requires-Python"] == ">=3.11"
    required = [line for line in metadata.get_all("Requires-Dist", []) if "extra ==" not in line]
    assert len(required) == len(PROJECT["dependencies"])
    assert metadata["License-Expression"] == "MIT AND BSD-3-Clause"


def test_every_package_asked_for_has_a_lowest_version(metadata: Message) -> None:
    asked = [line for line in metadata.get_all("Requires-Dist", []) if not line.startswith("glrt[")]
    assert [line for line in asked if ">=" not in line and "==" not in line.split(";")[0]] == []


def test_the_command_is_in_the_wheel(wheel: zipfile.ZipFile) -> None:
    entries = wheel.read(f"{INFO}/entry_points.txt").decode()
    assert "glrt = glrt.cli.main:main" in entries
    assert "[pytest11]\nglrt = glrt.testing.plugin" in entries
    assert "glrt/__main__.py" in wheel.namelist()
