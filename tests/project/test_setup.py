"""The set-up behind the Makefile: what it finds missing, what it keeps, what it makes again."""

import ast
import os
import re
import shutil
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from tests.support import slow_share

sys.path.insert(0, str(Path(__file__).parents[2] / "tools"))

import environment
import probes
import steps
import system

ROOT = Path(__file__).parents[2]
COMMITS = [f"{number:040x}" for number in range(100)]
TESTS = [f"tests/test_x.py::test_{number}" for number in range(100)]


@pytest.fixture
def commands(monkeypatch: pytest.MonkeyPatch) -> list[list[str]]:
    """The commands of the steps, recorded in place of being run; `fails` in one makes it fail."""
    recorded: list[list[str]] = []

    def record(title: str, command: list[str], **variables: str) -> tuple[bool, str]:
        recorded.append(command)
        if "venv" in command:
            fill(Path(command[-1]).parent)
        return not any("fails" in word for word in command), "ERROR: no network"

    monkeypatch.setattr(steps, "run", record)
    return recorded


@pytest.fixture
def checkout(tmp_path: Path) -> Path:
    folder = tmp_path / "a checkout"
    folder.mkdir()
    (folder / "pyproject.toml").write_text("[project]\n")
    return folder


def fill(checkout: Path) -> None:
    """An environment that answers as a real one does."""
    binaries = checkout / ".venv" / "bin"
    binaries.mkdir(parents=True)
    (binaries / "glrt").touch()
    (binaries / "python").write_text(f"#!/bin/sh\necho {environment._python()}\n")
    (binaries / "python").chmod(0o755)


def is_ready(checkout: Path, purpose: str = "render", strict: bool = False) -> bool:
    return environment.is_ready(str(checkout), purpose, strict)


def made(commands: list[list[str]]) -> list[str]:
    """The effects of the recorded commands: make an environment, install packages."""
    return ["venv" if "venv" in command else "pip" for command in commands]


def missing(*needs: system.Need) -> dict[system.Need, str]:
    return dict.fromkeys(needs, "not there")


def test_an_old_python_can_read_the_script_that_refuses_it() -> None:
    text = (ROOT / "tools" / "bootstrap.py").read_text()
    ast.parse(text, feature_version=(3, 7))


def test_a_library_that_is_not_there_is_named() -> None:
    assert "libnowhere.so.1" in probes.library("libnowhere.so.1", "libnowhere.so.0")
    assert probes.library("libnowhere.so.1", "libc.so.6") == ""


@pytest.mark.parametrize(
    ("driver", "reason"),
    [
        ("os.kill(os.getpid(), signal.SIGSEGV)", signal.SIGSEGV.name),
        ("sys.exit('no display')", "no display"),
        ("pass", ""),
    ],
)
def test_a_driver_may_fail_or_crash_without_ending_the_set_up(
    driver: str, reason: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    script = tmp_path / "driver.py"
    script.write_text(f"import os, signal, sys\n{driver}\n")
    monkeypatch.setattr(probes, "__file__", str(script))
    assert reason in probes._apart("egl")
    assert bool(probes._apart("egl")) == bool(reason)


@pytest.mark.parametrize(
    ("egl", "osmesa", "asked"), [("", "no", 0), ("no", "", 0), ("no", "no", 2)]
)
def test_a_render_asks_for_one_opengl_route(
    egl: str, osmesa: str, asked: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    needs = (system.EGL._replace(probe=lambda: egl), system.OSMESA._replace(probe=lambda: osmesa))
    monkeypatch.setattr(system, "EGL", needs[0])
    monkeypatch.setattr(system, "OSMESA", needs[1])
    monkeypatch.setattr(system, "WANTED", {"render": needs, "test": needs})
    assert len(system.find_missing("render")) == asked
    assert len(system.find_missing("test")) == bool(egl) + bool(osmesa)


def test_what_is_required_depends_on_who_asks(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(system, "_is_known", lambda _: True)
    for_tests = missing(system.OSMESA, system.XVFB)
    no_route = missing(system.EGL, system.OSMESA)
    assert system.required(for_tests, strict=False, apt=True) == []
    assert system.required(for_tests, strict=True, apt=True) == [system.OSMESA, system.XVFB]
    assert system.required(no_route, strict=False, apt=True) == [system.EGL]
    monkeypatch.setattr(system, "_is_known", lambda name: name != "libosmesa6")  # as of Mesa 25.1
    assert system.required(for_tests, strict=True, apt=True) == [system.XVFB]
    assert system.required(no_route, strict=False, apt=False) == []
    assert system.required(missing(system.VENV), strict=False, apt=False) == [system.VENV]


def test_an_environment_is_made_once(checkout: Path, commands: list[list[str]]) -> None:
    assert not is_ready(checkout)
    environment.make(str(checkout), "render", [])
    assert made(commands) == ["venv", "pip"]
    assert is_ready(checkout)
    assert is_ready(checkout, strict=True)


def test_tests_add_packages_to_the_environment_of_a_render(
    checkout: Path, commands: list[list[str]]
) -> None:
    environment.make(str(checkout), "render", [])
    assert not is_ready(checkout, "test")
    environment.make(str(checkout), "test", [])
    assert made(commands) == ["venv", "pip", "pip"]
    assert commands[-1][-1].endswith("[dev]")
    assert all(is_ready(checkout, purpose) for purpose in ("check", "render", "test"))


def test_benchmarks_and_ci_add_mitsuba_and_jupyter_which_tests_do_without(
    checkout: Path, commands: list[list[str]]
) -> None:
    environment.make(str(checkout), "test", [])
    assert not is_ready(checkout, "bench")
    environment.make(str(checkout), "bench", [])
    assert commands[-1][-1].endswith("[dev,mitsuba,jupyter]")
    assert all(is_ready(checkout, purpose, strict=True) for purpose in ("check", "test", "bench"))
    assert system.LLVM in system.WANTED["bench"]
    assert system.LLVM not in system.WANTED["test"]
    assert "tools/bootstrap.py bench" in (ROOT / ".ci" / "run").read_text()


def test_ci_is_not_content_with_a_set_up_that_lacks_something(
    checkout: Path, commands: list[list[str]]
) -> None:
    environment.make(str(checkout), "test", ["Xvfb"])
    assert is_ready(checkout, "test")
    assert not is_ready(checkout, "test", strict=True)
    assert is_ready(checkout, "render", strict=True)


def test_changed_dependencies_are_installed_on_top(
    checkout: Path, commands: list[list[str]]
) -> None:
    environment.make(str(checkout), "render", [])
    (checkout / "pyproject.toml").write_text("[project]\ndependencies = ['numpy']\n")
    assert not is_ready(checkout)
    environment.make(str(checkout), "render", [])
    assert made(commands) == ["venv", "pip", "pip"]


@pytest.mark.parametrize("state", ['{"unfinished": true}', '{"python": "3.', "[]"])
def test_an_interrupted_environment_is_made_again(
    state: str, checkout: Path, commands: list[list[str]]
) -> None:
    environment.make(str(checkout), "render", [])
    (checkout / ".venv" / environment.STATE_FILE).write_text(state)
    (checkout / ".venv" / "half").touch()
    assert not is_ready(checkout)
    environment.make(str(checkout), "render", [])
    assert made(commands) == ["venv", "pip", "venv", "pip"]
    assert not (checkout / ".venv" / "half").exists()


def test_a_moved_environment_is_made_again(checkout: Path, commands: list[list[str]]) -> None:
    environment.make(str(checkout), "render", [])
    moved = checkout.rename(checkout.parent / "moved")
    assert not is_ready(moved)
    environment.make(str(moved), "render", [])
    assert made(commands) == ["venv", "pip", "venv", "pip"]


def test_an_environment_made_by_hand_is_taken_over(
    checkout: Path, commands: list[list[str]]
) -> None:
    fill(checkout)
    environment.make(str(checkout), "render", [])
    assert made(commands) == ["pip"]


def test_an_environment_of_another_python_is_made_again(
    checkout: Path, commands: list[list[str]]
) -> None:
    fill(checkout)
    (checkout / ".venv" / "bin" / "python").write_text("#!/bin/sh\necho 3.10.0 /usr\n")
    environment.make(str(checkout), "render", [])
    assert made(commands) == ["venv", "pip"]


def test_a_failed_download_says_what_is_needed_and_keeps_the_environment(
    tmp_path: Path, commands: list[list[str]], capsys: pytest.CaptureFixture[str]
) -> None:
    checkout = tmp_path / "pip fails here"
    checkout.mkdir()
    (checkout / "pyproject.toml").touch()
    fill(checkout)
    for _ in range(2):
        with pytest.raises(SystemExit) as ended:
            environment.make(str(checkout), "render", [])
        assert ended.value.code == 1
    assert made(commands) == ["pip", "pip"]
    said = capsys.readouterr().err
    assert "ERROR: no network" in said
    assert "make render" in said


def test_help_lists_every_command() -> None:
    text = (ROOT / "Makefile").read_text()
    phony = re.search(r"^\.PHONY: (.*)$", text, re.MULTILINE)
    assert phony is not None
    targets = re.findall(r"^([a-z]+):.* ## .", text, re.MULTILINE)
    assert sorted(targets) == sorted(phony[1].split())


@pytest.mark.skipif(not shutil.which("make"), reason="needs make")
def test_make_without_a_command_shows_the_list() -> None:
    environ = {name: value for name, value in os.environ.items() if name != "MAKEFLAGS"}
    shown = subprocess.run(
        ["make", "--no-print-directory"],
        cwd=ROOT,
        env=environ,
        capture_output=True,
        text=True,
        check=True,
    )
    assert "make render" in shown.stdout
    assert "make test" in shown.stdout


def test_the_slow_share_draws_one_in_ten_again_for_each_commit() -> None:
    drawn = {
        commit: {test for test in TESTS if slow_share.is_drawn(test, commit, 1, 10)}
        for commit in COMMITS
    }
    total = sum(map(len, drawn.values()))
    expected, sigma = 10_000 / 10, (10_000 * 1 / 10 * 9 / 10) ** 0.5
    assert abs(total - expected) < 4 * sigma
    assert len(set(map(frozenset, drawn.values()))) == len(COMMITS)
    assert set().union(*drawn.values()) == set(TESTS)


def test_the_slow_share_is_a_fraction_up_to_one() -> None:
    assert slow_share.share("1/8") == (1, 8)
    assert all(slow_share.is_drawn(test, "", 8, 8) for test in TESTS)
    for text in ("9/8", "1/0", "half", "-1/8"):
        with pytest.raises(ValueError, match="share"):
            slow_share.share(text)


def test_the_limits_of_ci_fit_into_what_it_grants() -> None:
    text = (ROOT / ".ci" / "run").read_text()
    limits = [int(seconds) for seconds in re.findall(r"^within (\d+)", text, re.MULTILINE)]
    (grace,) = re.findall(r"--kill-after=(\d+)", text)
    assert len(limits) == 5
    assert sum(limits) + len(limits) * int(grace) <= 5400
