"""What the README tells a newcomer to type works as it stands there."""

import re
import shlex
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

from glrt.rendering.renderer import Renderer
from glrt.scene.toml import parse_scene
from tests.support.alarms import ALPHA, book
from tests.support.processes import glrt

ROOT = Path(__file__).parents[2]
README = (ROOT / "README.md").read_text()
SMALL = ("--width", "24", "--height", "16")


def blocks(language: str) -> list[str]:
    """The fenced blocks of one language."""
    return re.findall(rf"```{language}\n(.*?)```", README, re.DOTALL)


def commands(program: str) -> list[list[str]]:
    """The command lines of a program in all shell blocks."""
    lines = [line for block in blocks("sh") for line in block.splitlines()]
    split = [shlex.split(line, comments=True) for line in lines]
    return [words for words in split if words and words[0] == program]


def test_every_glrt_command_runs_in_order(tmp_path: Path) -> None:
    """Sizes are made small, long limits short; a crop or a recipe needs the size it has."""
    for words in commands("glrt"):
        line = words[1:]
        if line[0] == "compare":
            line += ["--alpha", str(ALPHA)]  # by default, chance calls one pair in 100 different
            book()
        if line[0] == "render":
            line += ["--width", "320", "--height", "400"] if "--crop" in line else SMALL
            line = ["0.5" if word == "0.1" else "1" if word == "20" else word for word in line]
            line += [] if {"--error", "--time", "--samples"} & set(line) else ["--samples", "2"]
        if line[0] == "chart":
            line += ["--height", "16", "--rounds", "2", "--seconds", "0.4"]
        done = glrt(*line, cwd=tmp_path)
        assert done.returncode == 0, f"{words}: {done.stderr}"
        if "-o" in line:
            assert (tmp_path / line[line.index("-o") + 1]).stat().st_size > 100


@pytest.mark.parametrize("target", sorted({words[1] for words in commands("make")}))
def test_every_make_target_exists(target: str) -> None:
    assert subprocess.run(["make", "-n", target], cwd=ROOT, capture_output=True).returncode == 0


def test_python_example_runs(tmp_path: Path) -> None:
    (code,) = blocks("python")
    careful = code.replace("(again, image)", f"(again, image, {ALPHA})")
    assert careful != code
    book()
    done = subprocess.run([sys.executable, "-c", careful], cwd=tmp_path, capture_output=True)
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "cornell.exr").exists()


def test_scene_file_renders() -> None:
    (text,) = blocks("toml")
    scene = parse_scene(tomllib.loads(text), "README")
    renderer = Renderer(scene, width=24, height=16)
    assert renderer.render(4).nonfinite() == 0
    renderer.release()


def test_extras_named_exist() -> None:
    named = set(re.findall(r"(?:glrt|\.)\[(\w+)\]", README))
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    assert "chart" in named
    assert named <= set(project["optional-dependencies"])


def test_map_names_every_module() -> None:
    names = {path.name for path in (ROOT / "glrt").glob("*.py")} - {"__init__.py", "__main__.py"}
    named = set(re.findall(r"`(?:glrt/)?(\w+\.py)`", README))
    assert names == named


def test_files_named_exist() -> None:
    for name in re.findall(r"\]\(([^)#:]+)\)", README):
        assert (ROOT / name).exists(), name
