"""The plugin as pytest loads it: the chance of a false alarm, its setting, and its cost."""

import subprocess
import sys
from pathlib import Path

import pytest

TESTS = """
import pytest

def test_one(picture):
    print("alpha", picture.alpha, picture.most)

@pytest.mark.pictures(3)
@pytest.mark.parametrize("number", [1, 2])
def test_three(picture, number):
    print("alpha", picture.alpha, picture.most)

def test_none():
    print("no picture")
"""


def run(folder: Path, *options: str) -> "subprocess.CompletedProcess[str]":
    """Run pytest on TESTS in a folder."""
    (folder / "test_pictures.py").write_text(TESTS)
    command = [sys.executable, "-m", "pytest", "-q", "-rP", "-p", "no:cacheprovider", *options]
    return subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=100)


@pytest.mark.slow_cases("two processes")
@pytest.mark.parametrize(
    ("options", "alphas"),
    [
        (("-n", "2"), {"alpha 0.001 1", "alpha 0.001 3"}),
        (("-k", "one", "-o", "glrt_alpha=0.5"), {"alpha 0.5 1"}),
    ],
    ids=["two processes", "one test"],
)
def test_the_chance_is_divided_among_the_pictures_that_are_collected(
    options: tuple[str, ...], alphas: set[str], tmp_path: Path
) -> None:
    done = run(tmp_path, "-o", "glrt_alpha=0.007", *options)
    assert done.returncode == 0, done.stdout
    assert {line for line in done.stdout.splitlines() if line.startswith("alpha")} == alphas


@pytest.mark.parametrize("given", ["much", "0", "1"])
def test_a_chance_that_is_none_is_refused(given: str, tmp_path: Path) -> None:
    done = run(tmp_path, "-o", f"glrt_alpha={given}")
    assert done.returncode == pytest.ExitCode.USAGE_ERROR
    assert f"glrt_alpha must be a number between 0 and 1, got '{given}'." in done.stderr


def test_a_page_that_cannot_be_written_is_one_paragraph(tmp_path: Path) -> None:
    done = run(tmp_path, "--glrt-html", "no/page.html")
    assert done.returncode != 0
    assert "--glrt-html: " in done.stdout + done.stderr
    assert "Traceback" not in done.stdout + done.stderr


PICTURES = """
def test_dim(picture):
    picture.check("cornell", samples=32, width=16, height=12)

def test_bright(picture):
    picture.check("sky", samples=32, width=16, height=12)
"""


@pytest.mark.slow
def test_two_processes_write_one_page(tmp_path: Path) -> None:
    (tmp_path / "test_two.py").write_text(PICTURES)
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", "-n", "2"]
    told = []
    for options in (["--glrt-update"], ["--glrt-html", "page.html"]):
        done = subprocess.run(
            [*command, *options], cwd=tmp_path, capture_output=True, text=True, timeout=200
        )
        assert done.returncode == 0, done.stdout
        told.append(done.stdout)
    assert f"glrt: wrote {tmp_path / 'references' / 'sky.exr'}" in told[0]
    assert "glrt: wrote page.html" in told[1]
    text = (tmp_path / "page.html").read_text()
    assert '"title": "cornell"' in text
    assert '"title": "sky"' in text
    assert sorted(file.name for file in tmp_path.iterdir() if file.is_dir()) == ["references"]


def test_pytest_loads_nothing_of_the_renderer() -> None:
    program = "import sys, pytest; before = set(sys.modules); import glrt.testing.plugin as p; \
        print(sorted(m for m in set(sys.modules) - before if not m.startswith('glrt')))"
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)
    assert done.stdout == "[]\n", done.stdout + done.stderr
