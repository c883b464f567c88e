"""This checkout against a commit: each side renders by its own glrt, and nothing stays behind."""

import json
import os
import shutil
import signal
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from bench import against
from bench.against import (
    PROGRAM,
    TRIAL_SEEDS,
    Row,
    Side,
    main,
    measure,
    overall,
    samples_for,
    table,
)
from bench.checkouts import commit_of, exported
from bench.processes import ROOT, Process, environment_of
from bench.ratios import LEAST_ROUNDS
from glrt.core.errors import RenderError, UsageError
from tests.support.system_packages import needs_package

LINE = ["--scenes", "sky", "--size", "8", "--rounds", str(LEAST_ROUNDS), "--seconds", "0.001"]


def needs_history() -> None:
    """Skip where these files are no checkout, as in a copy of them."""
    needs_package(bool(shutil.which("git")), "git")
    if not (ROOT / ".git").exists():
        pytest.skip("not a checkout")


@pytest.fixture
def repository(tmp_path: Path) -> Path:
    """A repository with one commit of a checkout whose glrt is a few lines."""
    needs_package(bool(shutil.which("git")), "git")
    folder = tmp_path / "repository"
    (folder / "glrt").mkdir(parents=True)
    (folder / "glrt" / "__init__.py").write_text("raise SystemExit('an old and broken glrt')\n")
    name = ["-c", "user.name=a", "-c", "user.email=a@b"]
    for command in (["init", "-q"], ["add", "."], [*name, "commit", "-qm", "Begin"]):
        subprocess.run(["git", *command], cwd=folder, check=True)
    return folder


class Told(Side):
    """A side that takes a given time for a sample, and says what it was asked."""

    def __init__(self, name: str, cost: float, asked: list[tuple[str, int, int]]) -> None:
        self.name, self._cost, self._asked = name, cost, asked
        self.starts = 1

    def restart(self) -> None:
        self.starts += 1

    def ask(self, do: str, **words: Any) -> dict[str, Any]:
        answers: dict[str, Callable[[], dict[str, Any]]] = {
            "open": lambda: {"compile_seconds": 0.25, "renderer": "Painter"},
            "render": lambda: self._render(**words),
            "close": lambda: {"peak_bytes": 100 << 20},
        }
        return answers[do]()

    def _render(self, samples: int, seed: int) -> dict[str, Any]:
        self._asked.append((self.name, samples, seed))
        return {"seconds": self._cost * samples, "sha256": str(seed)}


def row(**changes: Any) -> Row:
    figures: dict[str, Any] = {
        "scene": "sky",
        "samples": 64,
        "these": [1.0] * 8,
        "others": [1.0] * 8,
        "compile_seconds": (0.25, 0.5),
        "peak_bytes": (1 << 20, 2 << 20),
        "equal": True,
    }
    return Row(**{**figures, **changes})


def test_sides_take_turns_with_equal_seeds_and_samples() -> None:
    asked: list[tuple[str, int, int]] = []
    both = Told("this", 0.001, asked), Told("other", 0.002, asked)
    found, renderer = measure(both, "sky", 6, 0.5, size=8, method="mis", tier="fastest")
    assert renderer == "Painter"
    assert found.samples == 250, "by the slower side"
    assert found.these == pytest.approx([0.25] * 6)
    assert found.others == pytest.approx([0.5] * 6)
    assert found.equal
    runs = [run for run in asked if run[2] <= 6]
    assert runs[-4:] == [("this", 250, 5), ("other", 250, 5), ("other", 250, 6), ("this", 250, 6)]
    assert asked[-4:-2] == [("other", 62, TRIAL_SEEDS), ("this", 62, TRIAL_SEEDS)], "to warm up"


def test_each_round_has_processes_of_its_own() -> None:
    """Equal programs differ by 2 % from one start to the next."""
    both = Told("this", 0.001, []), Told("other", 0.002, [])
    measure(both, "sky", 6, 0.5, size=8, method="mis", tier="fastest")
    assert [side.starts for side in both] == [7, 7], "one to compile, one for each round"


def test_trials_have_seeds_that_no_round_has() -> None:
    asked: list[tuple[str, int, int]] = []
    samples_for([Told("this", 0.001, asked)], 0.1)
    assert len({seed for _, _, seed in asked}) == len(asked)
    assert min(seed for _, _, seed in asked) > 10**6


def test_the_table_reports_scenes_and_all_of_them() -> None:
    rows = [row(), row(scene="lens", these=[1.21] * 8, equal=False)]
    _, _, sky, lens, whole = table(rows)
    assert sky == (
        "| sky | 64 | 1.000 (1.000-1.000) | 1.000 s | 1.000 s | 0.25 s / 0.50 s "
        "| equal to the bit | no slower |"
    )
    assert "| differ | slower |" in lens
    assert "| 1.100 (1.100-1.100) | | | 0.50 s / 1.00 s | differ | slower |" in whole
    assert overall(rows).value == pytest.approx(1.1)


def test_the_exit_code_reports_what_is_slower(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    costs = iter([(1.0, 1.0), (1.5, 1.0)])

    class Sides:
        def __enter__(self) -> tuple[Side, Side]:
            this, other = next(costs)
            return Told("this", this, []), Told("other", other, [])

        def __exit__(self, *_: object) -> None:
            pass

    monkeypatch.setattr(against, "sides", lambda *_: Sides())
    monkeypatch.setattr(against, "commit_of", lambda *_: "abc")
    monkeypatch.setattr(against, "state_of", lambda: "def with changes")
    file = tmp_path / "against.json"
    assert main(["abc", *LINE, "--json", str(file)]) == 0
    printed = capsys.readouterr().out
    assert printed.endswith("\npeak memory: this 100 MiB, other 100 MiB\nno slower\n")
    assert "Painter" in printed
    assert "this: def with changes; other: abc" in printed
    saved = json.loads(file.read_text())
    assert saved["verdict"] == "no slower"
    assert saved["rows"][0]["ratio"] == {"value": 1.0, "low": 1.0, "high": 1.0}
    assert main(["abc", *LINE]) == 1
    assert capsys.readouterr().out.endswith("\nslower\n")


@pytest.mark.slow
def test_the_checkout_is_compared_with_its_own_commit(capsys: pytest.CaptureFixture[str]) -> None:
    """Its files may have been edited since: whether they are slower is not for this test."""
    needs_history()
    assert main(["HEAD", *LINE]) in (0, 1)
    printed = capsys.readouterr()
    assert printed.err == "sky ...\n"
    assert "| sky |" in printed.out


@pytest.mark.slow
def test_a_side_renders_what_it_is_asked(tmp_path: Path) -> None:
    command, environment = [sys.executable, "-P", str(PROGRAM)], environment_of(ROOT, tmp_path)
    side = Side("this", lambda: Process(command, tmp_path / "log", environment))
    try:
        assert side.glrt == ROOT / "glrt" / "__init__.py"
        opened = side.ask("open", scene="sky", size=8, method="mis", tier="fastest")
        assert opened["compile_seconds"] > 0
        hashes = [side.ask("render", samples=4, seed=seed)["sha256"] for seed in (1, 2, 1)]
        assert hashes[0] == hashes[2] != hashes[1]
        assert side.ask("close")["peak_bytes"] > 10 << 20
        with pytest.raises(RenderError, match=r"^this: SceneError: Unknown scene 'ski'"):
            side.ask("open", scene="ski", size=8, method="mis", tier="fastest")
        side.restart()
        with pytest.raises(RenderError, match=r"^this: AttributeError"):
            side.ask("render", samples=4, seed=1)  # the new process has opened nothing
    finally:
        side.end()


def test_a_commit_is_there_for_a_while(repository: Path) -> None:
    commit = commit_of("HEAD", repository)
    with exported(commit, repository) as folder:
        assert (folder / "glrt" / "__init__.py").exists()
        assert [path.name for path in folder.iterdir()] == ["glrt"]
    assert not folder.exists()


@pytest.mark.parametrize("name", ["no-such-commit", "--all", ""])
def test_an_unknown_commit_is_refused(repository: Path, name: str) -> None:
    with pytest.raises(UsageError, match=r"there is no commit"):
        commit_of(name, repository)


def test_a_commit_that_does_not_start_is_reported(
    repository: Path, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    monkeypatch.setattr(against, "exported", lambda commit: exported(commit, repository))
    with (
        pytest.raises(RenderError, match=r"^HEAD: an old and broken glrt$"),
        against.sides("HEAD", None),
    ):
        raise AssertionError
    assert [path.name for path in tmp_path.iterdir()] == ["repository"]


def test_the_number_of_threads_is_set_where_it_is_asked_for(
    repository: Path, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """Where nobody asks for a number, it is left alone."""
    program = tmp_path / "program.py"
    program.write_text(
        "import json, os, sys\n"
        "path = sys.path[0] + '/glrt/' + os.environ.get('LP_NUM_THREADS', 'unset')\n"
        "print(json.dumps({'glrt': path}), flush=True)\n"
        "sys.stdin.read()\n"
    )
    monkeypatch.setattr(against, "PROGRAM", program)
    monkeypatch.setattr(against, "exported", lambda commit: exported(commit, repository))
    monkeypatch.delenv("LP_NUM_THREADS", raising=False)
    for threads, told in ((None, "unset"), (3, "3")):
        with against.sides("HEAD", threads) as both:
            assert [side.glrt.name for side in both] == [told, told]


@pytest.mark.slow
def test_nothing_stays_behind_after_ctrl_c(tmp_path: Path) -> None:
    needs_history()
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "TMPDIR": str(tmp_path)}
    command = [sys.executable, "-m", "bench.against", "HEAD", *LINE, "--rounds", "100000"]
    with subprocess.Popen(command, stderr=subprocess.PIPE, text=True, env=environment) as process:
        assert process.stderr
        assert process.stderr.readline() == "sky ...\n"
        assert len(list(tmp_path.iterdir())) == 2, "the commit, and caches of drivers"
        process.send_signal(signal.SIGINT)
        assert process.stderr.read() == "glrt: interrupted\n"
    assert process.returncode == 128 + signal.SIGINT
    assert list(tmp_path.iterdir()) == []
