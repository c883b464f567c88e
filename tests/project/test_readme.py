"""Commands that the README and the guides ask people to type work as they stand there."""

import re
import shlex
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

from glrt.rendering.renderer import Renderer
from glrt.scene.scenefile.toml import parse_scene
from glrt.scene.warnings import cautions
from glrt.settings import settings_for
from tests.support.alarms import ALPHA, book
from tests.support.processes import glrt

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"
README = ROOT / "README.md"
WRITING_A_SCENE = DOCS / "how-to" / "write-a-scene.md"
PAGES = [  # whose commands run
    README,
    DOCS / "tutorial.md",
    *(DOCS / "how-to" / f"{name}.md" for name in ("choose-a-method", "compare", "resume")),
]
SMALL = ("--width", "24", "--height", "16")
QUICK = {"0.05": "0.5", "0.1": "0.5"}  # errors


def blocks(page: Path, language: str) -> list[str]:
    """The fenced blocks of one language."""
    return re.findall(rf"```{language}\n(.*?)```", page.read_text(), re.DOTALL)


def commands(page: Path, program: str) -> list[list[str]]:
    """The command lines of a program in all shell blocks."""
    lines = [line for block in blocks(page, "sh") for line in block.splitlines()]
    split = [shlex.split(line, comments=True) for line in lines]
    return [words for words in split if words and words[0] == program]


def save_scenes(page: Path, folder: Path) -> None:
    """The scenes of a page whose first line is their file name, as in `# room.toml`."""
    for text in blocks(page, "toml"):
        if named := re.match(r"# (\w+\.toml)\n", text):
            (folder / named[1]).write_text(text)


@pytest.mark.slow_cases("README", "choose-a-method", "tutorial")
@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_every_glrt_command_runs_in_order(page: Path, tmp_path: Path) -> None:
    """Sizes are made small, long limits short; a recipe has the size it has."""
    save_scenes(page, tmp_path)
    for words in commands(page, "glrt"):
        line = words[1:]
        if line[0] == "view":
            continue
        if line[0] == "compare":
            line += ["--alpha", str(ALPHA)]  # by default, chance calls one pair in 100 different
            book()
        line = [QUICK.get(word, word) for word in line]
        if line[0] == "render":
            line += SMALL
            line += [] if {"--error", "--time", "--samples"} & set(line) else ["--samples", "2"]
        if line[0] == "chart":
            line += ["--height", "16", "--rounds", "2", "--seconds", "0.4"]
        done = glrt(*line, cwd=tmp_path)
        assert done.returncode == 0, f"{words}: {done.stderr}"
        if "-o" in line:
            assert (tmp_path / line[line.index("-o") + 1]).stat().st_size > 100


@pytest.mark.parametrize("target", sorted({words[1] for words in commands(README, "make")}))
def test_every_make_target_exists(target: str) -> None:
    assert subprocess.run(["make", "-n", target], cwd=ROOT, capture_output=True).returncode == 0


def test_python_example_runs(tmp_path: Path) -> None:
    (code,) = blocks(README, "python")
    careful = code.replace("(again, image)", f"(again, image, {ALPHA})")
    assert careful != code
    book()
    done = subprocess.run([sys.executable, "-c", careful], cwd=tmp_path, capture_output=True)
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "cornell.exr").exists()


@pytest.mark.parametrize("text", blocks(WRITING_A_SCENE, "toml"), ids=["room", "glass of water"])
def test_scene_file_renders(text: str) -> None:
    scene = parse_scene(tomllib.loads(text), WRITING_A_SCENE.name)
    assert cautions(scene, settings_for(scene.render)) == []
    renderer = Renderer(scene, width=24, height=16)
    assert renderer.render(4).nonfinite() == 0
    renderer.release()


def test_extras_named_exist() -> None:
    text = "".join(page.read_text() for page in [README, *DOCS.rglob("*.md")])
    named = set(re.findall(r"(?:glrt|\.)\[([\w,]+)\]'", text))
    extras = {extra for names in named for extra in names.split(",")}
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    assert {"chart", "view"} <= extras <= set(project["optional-dependencies"])


def test_the_map_names_every_package() -> None:
    packages = {path.parent.name for path in (ROOT / "glrt").glob("*/__init__.py")}
    assert packages == set(re.findall(r"^\| `glrt/(\w+)` ", README.read_text(), re.MULTILINE))
