"""Everything that the README and the pages of docs/ refer to exists."""

import re
import subprocess
from importlib.util import find_spec
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PAGES = [ROOT / "README.md", ROOT / "CHANGELOG.md", *sorted((ROOT / "docs").rglob("*.md"))]
OF_READERS = {  # files that a page asks readers to make, and the one that is written for a scene
    *("test_pictures.py", "test_pictures", "scene_arrays.glsl"),
    *("shaders_glsl/shapes/annulus.glsl", "shaders_glsl/lights/annulus.glsl"),
    "shaders_glsl/bsdfs/velvet.glsl",
    *("glrt/scene/shapes/annulus.py", "glrt/scene/materials/velvet.py"),
}
SOURCE = r"`((?:[\w.-]+/)*[\w-]+\.(?:py|glsl|comp|vert|frag|wgsl))\b"
FENCED = re.compile(r"^```.*?^```", re.DOTALL | re.MULTILINE)

pages = pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))


def tracked() -> set[str]:
    """The files of the repository, those not added yet included."""
    command = ["git", "ls-files", "-co", "--exclude-standard"]
    listed = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True)
    return set(listed.stdout.splitlines())


FILES = tracked()


def anchors(page: Path) -> set[str]:
    """The names by which GitHub links to the headings of a page."""
    headings = re.findall(r"^#+ (.*)$", FENCED.sub("", page.read_text()), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


def exists(name: str) -> bool:
    """Whether a file is in the repository, by its path or by the end of its path."""
    return any(file == name or file.endswith(f"/{name}") for file in FILES)


@pages
def test_relative_links_lead_somewhere(page: Path) -> None:
    for link in re.findall(r"\]\(([^)\s]+)\)", FENCED.sub("", page.read_text())):
        if re.match(r"\w+:", link):
            continue
        name, _, anchor = link.partition("#")
        target = (page.parent / name).resolve() if name else page
        assert target.exists(), link
        assert not anchor or anchor in anchors(target), link


@pages
def test_modules_that_are_run_exist(page: Path) -> None:
    """Files of a commit that the page names are excepted."""
    for module in re.findall(r"python -m ([\w.]*\w)(?![^`]*` at commit)", page.read_text()):
        assert find_spec(module) is not None, module


@pages
def test_source_files_that_are_named_exist(page: Path) -> None:
    for name in re.findall(SOURCE, page.read_text()):
        assert name in OF_READERS or exists(name), name


@pages
def test_tests_that_are_named_exist(page: Path) -> None:
    for name in re.findall(r"`(test_\w+)`", page.read_text()):
        assert name in OF_READERS or exists(f"{name}.py"), name


def test_pages_that_source_files_name_exist() -> None:
    """Comments and docstrings name pages by their path."""
    sources = [
        path
        for name in ("glrt", "bench", "shaders_glsl", "tests", "tools", "scenes")
        for path in (ROOT / name).rglob("*")
        if path.suffix in (".py", ".glsl", ".comp", ".vert", ".frag", ".wgsl", ".toml")
    ]
    named = {
        name for file in sources for name in re.findall(r"\bdocs/[\w/-]+\.md\b", file.read_text())
    }
    assert [name for name in sorted(named) if not (ROOT / name).exists()] == []


def test_every_page_is_in_the_index() -> None:
    index = ROOT / "docs" / "README.md"
    links = re.findall(r"\]\(([^)#\s]+)\)", index.read_text())
    linked = {(index.parent / link).resolve() for link in links}
    assert set((ROOT / "docs").rglob("*.md")) - {index} <= linked
