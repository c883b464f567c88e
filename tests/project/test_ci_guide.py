"""The test of pictures that docs/how-to/ci.md gives people for their CI works."""

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
from PIL import Image as Pillow

from glrt.core.resources import folder
from glrt.gpu.context import ADVICE
from tests.support.processes import glrt

PAGE = (Path(__file__).parents[2] / "docs" / "how-to" / "ci.md").read_text()


def block(language: str) -> str:
    """The first block of a language on the page."""
    found = re.search(rf"```{language}\n(.*?)```", PAGE, re.DOTALL)
    assert found
    return found[1]


@pytest.fixture(scope="module")
def project(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A project that follows the page: a scene, its reference, and the test."""
    here = tmp_path_factory.mktemp("project")
    (here / "scenes").mkdir()
    text = (folder("scenes") / "cornell.toml").read_text()
    (here / "scenes" / "room.toml").write_text(text)
    (here / "test_pictures.py").write_text(block("python"))
    code, told = run_pytest(here, *block("sh").split()[1:-1])
    assert code == 0, told
    assert f"glrt: wrote {here / 'references' / 'room.exr'}" in told
    return here


def run_pytest(project: Path, *options: str) -> tuple[int, str]:
    """Exit code and output of pytest there, in two processes."""
    return run_step(project, f"pytest {' '.join(options)} test_pictures.py")


def run_step(project: Path, step: str) -> tuple[int, str]:
    """Exit code and output of a shell command there, with the programs of this environment."""
    path = f"{Path(sys.executable).parent}:{os.environ['PATH']}"
    more = {"PATH": path, "PYTEST_ADDOPTS": "-q -p no:cacheprovider -n 2"}
    command = ["bash", "-e", "-c", step]
    done = subprocess.run(
        command,
        cwd=project,
        env={**os.environ, **more},
        capture_output=True,
        text=True,
        timeout=200,
    )
    return done.returncode, done.stdout + done.stderr


def steps() -> list[str]:
    """The shell commands of the workflow that stand on one line, in order."""
    return re.findall(r"^ +- run: (.+)$", block("yaml"), re.MULTILINE)


def entries(page: Path) -> dict[str, str]:
    """The verdict of each picture that a page shows, by its title."""
    found = re.search(r'application/json">(.*?)</script>', page.read_text(), re.DOTALL)
    assert found
    return {entry["title"]: entry["verdict"] for entry in json.loads(found[1])}


def test_the_workflow_installs_checks_and_tests() -> None:
    programs = [step.split()[0] for step in steps()]
    assert programs == ["pip", "glrt", "pytest"]


@pytest.mark.slow
def test_the_workflow_passes_on_a_right_picture(project: Path) -> None:
    for step in steps()[1:]:  # without the network
        code, told = run_step(project, step)
        assert code == 0, told
    assert "1 passed" in told
    assert entries(project / "page.html").keys() == {"room"}
    assert entries(project / "page.html")["room"] != "different"
    assert not (project / "failed").exists()


@pytest.mark.slow
def test_the_workflow_fails_on_a_wrong_picture_and_shows_it(project: Path) -> None:
    scene = project / "scenes" / "room.toml"
    right = scene.read_text()
    scene.write_text(right.replace("[7.6, 7.2, 6.5]", "[8.36, 7.92, 7.15]"))
    try:
        code, told = run_step(project, steps()[-1])
    finally:
        scene.write_text(right)
    assert code == 1, told
    assert "different" in told
    assert entries(project / "page.html") == {"room": "different"}
    shown = sorted((project / "failed").iterdir())
    assert [file.name for file in shown] == [
        "room-difference.png",
        "room-reference.png",
        "room.png",
    ]
    for file in shown:
        with Pillow.open(file) as picture:
            assert min(picture.size) >= 64
    kept = block("yaml").rpartition("path: |")[2].split()
    assert kept == ["failed/", "page.html"]
    assert all((project / path).exists() for path in kept)


@pytest.mark.slow
def test_the_number_of_threads_changes_no_bit(tmp_path: Path) -> None:
    """The page promises this; the variable is llvmpipe's."""
    bits = []
    for threads in ("0", "3"):
        file = tmp_path / f"{threads}.npy"
        size = "--width", "40", "--height", "24", "--samples", "5"
        done = glrt("render", "lens", "-o", file, *size, cwd=None, LP_NUM_THREADS=threads)
        assert done.returncode == 0, done.stderr
        bits.append(file.read_bytes())
    assert bits[0] == bits[1]


def test_both_caches_of_mesa_are_kept() -> None:
    """Newer versions keep kernels in one file, in a folder of another name."""
    kept = set(re.findall(r"^ +~/\.cache/(\w+)$", block("yaml"), re.MULTILINE))
    assert kept == {"mesa_shader_cache", "mesa_shader_cache_db"}


def test_the_packages_named_are_what_the_advice_names() -> None:
    named = re.findall(r"lib[\w-]+", ADVICE)
    assert len(named) >= 4
    for text in (block("yaml"), block("dockerfile")):
        assert set(named) <= set(re.findall(r"lib[\w-]+", text))
