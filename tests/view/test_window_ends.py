"""How the window ends: closed, killed, without a display, or refused."""

import json
import os
import signal
import subprocess
import sys
import textwrap
import time
from pathlib import Path

import pytest

from glrt.image.image import Image
from glrt.view.opening import LARGE
from tests.support.processes import glrt

ROOT = Path(__file__).parents[2]


@pytest.mark.slow_cases("0.8")
@pytest.mark.parametrize("seconds", [0.3, 0.8])
def test_a_window_that_is_killed_while_it_starts_leaves_no_traceback(
    display: str, tmp_path: Path, seconds: float
) -> None:
    command = [sys.executable, "-m", "glrt", "view", "cornell", "--width", "32", "--height", "32"]
    environment = {**os.environ, "DISPLAY": display, **folders(tmp_path)}
    pipe = subprocess.PIPE
    with subprocess.Popen(command, env=environment, stderr=pipe, text=True) as window:
        time.sleep(seconds)
        window.send_signal(signal.SIGTERM)
        _, told = window.communicate(timeout=250)
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


@pytest.mark.slow
@pytest.mark.slow_cases(
    "resting*", "dragging*", "closing_with_edits*", "choosing*", "saving_when_killed*"
)
@pytest.mark.parametrize(
    ("moment", "code"),
    [
        *((name, 143) for name in ("compiling", "dragging", "choosing", "saving", "resting")),
        ("saving_when_killed", -signal.SIGKILL),
        ("closing", 0),
        ("closing_with_edits", 0),
        ("terminated_with_edits", 143),
    ],
)
def test_a_window_ends_at_any_moment(display: str, tmp_path: Path, moment: str, code: int) -> None:
    preferences = tmp_path / "config" / "glrt" / "view.json"
    preferences.parent.mkdir(parents=True)
    preferences.write_text('{"theme": "light"}')
    done = ended_at(moment, display, tmp_path)
    assert (done.returncode, done.stderr) == (code, "")
    picture = tmp_path / "picture.exr"
    if moment == "saving":
        assert Image.load(picture).recipe
    if moment == "saving_when_killed":
        return assert_gone(picture)
    tab = {"tab": "Scene"} if moment.endswith("with_edits") else {}  # which the edit has opened
    assert json.loads(preferences.read_text()) == {"theme": "light", "mode": "fly", **tab}
    assert list(tmp_path.rglob(".glrt-*")) == []
    assert len(kept_edits(tmp_path)) == (moment in ("terminated_with_edits", "dragging"))
    if moment == "choosing":
        assert_gone(Path("/proc") / (tmp_path / "dialog.pid").read_text().strip())
    return None


@pytest.mark.slow
@pytest.mark.parametrize("moment", ["starting", "leaving_the_start"])
def test_a_window_without_a_scene_lets_one_be_chosen(
    display: str, tmp_path: Path, moment: str
) -> None:
    done = ended_at(moment, display, tmp_path)
    assert (done.returncode, done.stderr) == (143, "")


@pytest.mark.slow
def test_a_large_model_that_is_wrong_ends_the_window_that_waits_for_it(
    display: str, tmp_path: Path
) -> None:
    model = tmp_path / "wrong.obj"
    model.write_text("v 0 0\n" * (LARGE // 6 + 1))
    done = glrt("view", model, cwd=None, DISPLAY=display, **folders(tmp_path))
    assert (done.returncode, done.stderr.count("\n")) == (2, 1)
    assert "wrong.obj" in done.stderr


@pytest.mark.slow
def test_the_edits_of_a_killed_window_are_restored_in_the_next(
    display: str, tmp_path: Path
) -> None:
    assert ended_at("killed_with_edits", display, tmp_path).returncode == -signal.SIGKILL
    (kept,) = kept_edits(tmp_path)
    scene = kept.read_text()
    restored = ended_at("restoring", display, tmp_path)
    assert (restored.returncode, restored.stderr) == (143, "")
    (again,) = kept_edits(tmp_path)
    assert again != kept
    assert again.read_text().splitlines()[1:] == scene.splitlines()[1:]


@pytest.mark.slow
@pytest.mark.skipif(sys.platform != "linux", reason="looks at /proc")
def test_an_export_ends_with_a_window_that_is_killed(display: str, tmp_path: Path) -> None:
    assert ended_at("exporting_when_killed", display, tmp_path).returncode == -signal.SIGKILL
    state = Path("/proc") / (tmp_path / "export.pid").read_text().strip() / "stat"
    deadline = time.monotonic() + 60
    while is_alive(state):
        assert time.monotonic() < deadline, "nobody reads its progress any more"
        time.sleep(0.1)
    assert not (tmp_path / "long.png").exists()


@pytest.mark.slow
@pytest.mark.skipif(sys.platform != "linux", reason="elsewhere there is always a display")
def test_edits_outlive_the_display(display: str, tmp_path: Path) -> None:
    done = ended_at("display_lost_with_edits", display, tmp_path)
    (kept,) = kept_edits(tmp_path)
    assert done.returncode == 3
    assert str(kept) in done.stderr
    assert done.stderr.count("\n") == 1


def ended_at(moment: str, display: str, base: Path) -> "subprocess.CompletedProcess[str]":
    """Run a window in a folder until it ends at a moment; see `tests/window/moments.py`."""
    dialog = base / "zenity"
    dialog.write_text("#!/bin/sh\necho $$ > dialog.new\nmv dialog.new dialog.pid\nexec sleep 99\n")
    dialog.chmod(0o755)
    environment = {
        "DISPLAY": display,
        **folders(base),
        "PATH": f"{base}:{os.environ['PATH']}",
        "PYTHONPATH": os.pathsep.join([str(ROOT), *sys.path]),
    }
    return subprocess.run(
        [sys.executable, "-m", "tests.window.moments", moment],
        capture_output=True,
        text=True,
        cwd=base,
        env={**os.environ, **environment},
        timeout=250,
    )


def kept_edits(base: Path) -> list[Path]:
    return list((base / "state" / "glrt" / "recovery").glob("*.toml"))


def is_alive(state: Path) -> bool:
    """Whether a process runs, by its file in /proc; one that nobody has waited for does not."""
    try:
        return state.read_text().rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False


def folders(base: Path) -> dict[str, str]:
    """Variables of the environment for folders of the user below another folder."""
    return {f"XDG_{kind.upper()}_HOME": str(base / kind) for kind in ("config", "state")}


def assert_gone(path: Path) -> None:
    assert not path.exists()


@pytest.mark.slow
@pytest.mark.skipif(sys.platform != "linux", reason="elsewhere there is always a display")
def test_without_a_display_the_advice_is_to_render() -> None:
    done = glrt("view", "cornell", DISPLAY="", WAYLAND_DISPLAY="")
    assert done.returncode == 3
    assert "glrt render" in done.stderr
    assert done.stderr.count("\n") == 1


def test_without_the_extra_the_advice_is_to_install_it(tmp_path: Path) -> None:
    code = (
        "import sys; sys.modules['imgui_bundle'] = None; "
        "from glrt.cli.main import main; sys.exit(main(['view', 'cornell']))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert done.returncode == 2
    assert "-m pip install" in done.stderr
    assert done.stderr.count("\n") == 1


def test_a_bad_scene_is_refused_before_a_window_opens() -> None:
    done = glrt("view", "cornel", DISPLAY="")
    assert done.returncode == 2
    assert "cornell" in done.stderr


@pytest.mark.slow
def test_a_display_that_goes_away_while_the_window_starts_is_reported(display: str) -> None:
    code = (
        "import os; from glrt.view import window; run = window.Window.run\n"
        "def gone(self): os.environ['DISPLAY'] = ':4242'; return run(self)\n"
        "window.Window.run = gone\n"
        "from glrt.cli.main import main; raise SystemExit(main(['view', 'cornell']))"
    )
    command, environment = [sys.executable, "-c", code], {**os.environ, "DISPLAY": display}
    done = subprocess.run(command, capture_output=True, text=True, env=environment)
    assert done.returncode == 3
    assert "no window can be opened, though" in done.stderr
    assert "glrt render" in done.stderr
    assert "Traceback" not in done.stderr
