"""The window under an X server without a screen: used by hand, killed, or not to be had.

Each check of `tests/window_checks.py` is a test here; some share a window and its process.
"""

import ast
import json
import os
import shutil
import signal
import subprocess
import sys
import textwrap
import time
from collections.abc import Callable, Iterator
from ctypes.util import find_library
from pathlib import Path

import pytest

from glrt.image import Image
from glrt.lab.screens import screen
from tests.drivers import OLD_DRIVER
from tests.packages import needs_package
from tests.processes import glrt

ROOT = Path(__file__).parents[1]
CHECKS = [
    node.name
    for node in ast.parse((ROOT / "tests" / "window_checks.py").read_text()).body
    if isinstance(node, ast.FunctionDef) and node.decorator_list
]
pytestmark = pytest.mark.timeout(600)  # of a machine that has other things to do as well
SHARING = 9  # checks in one window, so that a slow machine ends them in time
ON_OLD_DRIVERS = (
    "the_driver_decides_on_the_pipeline",
    "the_picture_never_goes_black",
    "a_drag_turns_by_its_share_of_the_window",
    "a_picture_is_saved_with_its_recipe_and_opened_again",
    "a_kept_picture_is_compared_by_a_wipe",
    "a_compilation_is_announced_while_the_old_picture_stays",
    "an_object_is_edited_in_the_panel",
    "views_cost_no_sample_and_have_a_legend",
)


@pytest.fixture(scope="module")
def display() -> Iterator[str]:
    needs_package(bool(shutil.which("Xvfb")), "xvfb")
    needs_package(bool(find_library("X11")), "libx11-6")
    with screen("1280x1100") as name:
        yield name


@pytest.fixture(scope="module")
def found(display: str, tmp_path_factory: pytest.TempPathFactory) -> Callable[[str], str]:
    """What a check found wrong, "" for nothing; some checks share a window."""
    results: dict[int, dict[str, str]] = {}

    def of(check: str) -> str:
        group = CHECKS.index(check) // SHARING
        if group not in results:
            names = CHECKS[group * SHARING : (group + 1) * SHARING]
            results[group] = checked(display, tmp_path_factory.mktemp("window"), *names)
        return results[group].get(check) or results[group].get("window", "")

    return of


def checked(display: str, folder: Path, *names: str, **variables: str) -> dict[str, str]:
    """What the checks of these names, or all, found in a window of their own.

    They work on a copy of the sources, and break its shaders.
    """
    for name in ("glrt", "shaders_glsl", "scenes", "tests"):
        shutil.copytree(ROOT / name, folder / name, ignore=shutil.ignore_patterns("__pycache__"))
    environment = {
        "DISPLAY": display,
        "XDG_CONFIG_HOME": str(folder / "config"),
        "PYTHONPATH": os.pathsep.join([str(folder), *sys.path]),
    }
    told = subprocess.run(
        [
            sys.executable,
            "-W",
            "error",
            "-c",
            "from tests.hand import main; main()",
            str(folder),
            *names,
        ],
        capture_output=True,
        text=True,
        cwd=folder,
        env={**os.environ, **environment, **variables},
        timeout=580,
    )
    file = folder / "found.json"
    assert file.exists(), told.stdout[-2000:] + told.stderr[-4000:]
    result: dict[str, str] = json.loads(file.read_text())
    return {**dict.fromkeys(names, "did not run"), **result}


@pytest.mark.parametrize("check", CHECKS)
def test_in_the_window(found: Callable[[str], str], check: str) -> None:
    assert found(check) == ""


def test_the_window_works_without_compute_shaders(display: str, tmp_path: Path) -> None:
    arguments = "view", "cornell", "--pipeline", "compute"
    needed = glrt(*arguments, cwd=None, DISPLAY=display, **OLD_DRIVER)
    assert needed.returncode == 3
    assert "OpenGL 4.3" in needed.stderr
    found = checked(display, tmp_path, *ON_OLD_DRIVERS, **OLD_DRIVER)
    assert found == dict.fromkeys(ON_OLD_DRIVERS, "")


@pytest.mark.parametrize("seconds", [0.3, 0.8])
def test_a_window_that_is_killed_while_it_starts_leaves_no_traceback(
    display: str, tmp_path: Path, seconds: float
) -> None:
    command = [sys.executable, "-m", "glrt", "view", "cornell", "--width", "32", "--height", "32"]
    environment = {**os.environ, "DISPLAY": display, "XDG_CONFIG_HOME": str(tmp_path)}
    pipe = subprocess.PIPE
    with subprocess.Popen(command, env=environment, stderr=pipe, text=True) as window:
        time.sleep(seconds)
        window.send_signal(signal.SIGTERM)
        _, told = window.communicate(timeout=60)
    assert window.returncode in (143, -signal.SIGTERM)
    assert "Traceback" not in told


def test_a_signal_raises_nothing_in_compiled_packages_that_are_loading(tmp_path: Path) -> None:
    loading = """
        import os, signal, time
        try:
            os.kill(os.getpid(), signal.SIGTERM)
            time.sleep(10)
        except BaseException:
            os.abort()  # as C++ does, whose code is left by an exception of Python
    """
    (tmp_path / "imgui_bundle.py").write_text(textwrap.dedent(loading))
    search = os.pathsep.join([str(tmp_path), *sys.path])
    ended = glrt("view", "cornell", PYTHONPATH=search)
    assert (ended.returncode, ended.stdout) == (143, "")
    assert "Traceback" not in ended.stderr


@pytest.mark.parametrize(
    ("moment", "code"),
    [
        *((name, 143) for name in ("compiling", "dragging", "choosing", "saving")),
        ("saving_when_killed", -signal.SIGKILL),
        ("closing", 0),
    ],
)
def test_a_window_ends_at_any_moment(display: str, tmp_path: Path, moment: str, code: int) -> None:
    dialog = tmp_path / "zenity"
    dialog.write_text("#!/bin/sh\necho $$ > dialog.new\nmv dialog.new dialog.pid\nexec sleep 99\n")
    dialog.chmod(0o755)
    preferences = tmp_path / "config" / "glrt" / "view.json"
    preferences.parent.mkdir(parents=True)
    preferences.write_text('{"theme": "light"}')
    environment = {
        "DISPLAY": display,
        "XDG_CONFIG_HOME": str(tmp_path / "config"),
        "PATH": f"{tmp_path}:{os.environ['PATH']}",
        "PYTHONPATH": os.pathsep.join([str(ROOT), *sys.path]),
    }
    done = subprocess.run(
        [sys.executable, "-m", "tests.moments", moment],
        capture_output=True,
        text=True,
        cwd=tmp_path,
        env={**os.environ, **environment},
        timeout=100,
    )
    assert (done.returncode, done.stderr) == (code, "")
    picture = tmp_path / "picture.exr"
    if moment == "saving":
        assert Image.load(picture).recipe
    if moment == "saving_when_killed":
        return assert_gone(picture)
    assert json.loads(preferences.read_text()) == {"theme": "light", "mode": "fly"}
    assert list(tmp_path.rglob(".glrt-*")) == []
    if moment == "choosing":
        assert_gone(Path("/proc") / (tmp_path / "dialog.pid").read_text().strip())
    return None


def assert_gone(path: Path) -> None:
    assert not path.exists()


@pytest.mark.skipif(sys.platform != "linux", reason="elsewhere there is always a display")
def test_without_a_display_the_advice_is_to_render() -> None:
    done = glrt("view", "cornell", DISPLAY="", WAYLAND_DISPLAY="")
    assert done.returncode == 3
    assert "glrt render" in done.stderr
    assert done.stderr.count("\n") == 1


def test_without_the_extra_the_advice_is_to_install_it(tmp_path: Path) -> None:
    code = (
        "import sys; sys.modules['imgui_bundle'] = None; "
        "from glrt.cli import main; sys.exit(main(['view', 'cornell']))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert done.returncode == 2
    assert "pip install 'glrt[view]'" in done.stderr
    assert done.stderr.count("\n") == 1


def test_a_bad_scene_is_refused_before_a_window_opens() -> None:
    done = glrt("view", "cornel", DISPLAY="")
    assert done.returncode == 2
    assert "cornell" in done.stderr
