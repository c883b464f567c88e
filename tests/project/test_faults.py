"""Faults around a render, provoked: nothing that was saved is lost, one paragraph, exit 4.

docs/reference/faults.md is the table of all faults, with the tests that stand elsewhere.
"""

import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from glrt.analysis.reference import Budget, reference_for
from glrt.cli import autosave
from glrt.cli.main import main
from glrt.core.errors import RenderError
from glrt.gpu import glsl
from glrt.gpu.context import Context
from glrt.image.image import Image
from glrt.image.sources import load
from glrt.rendering.renderer import Renderer
from glrt.rendering.schedule import HEADLESS, DispatchPolicy, DispatchRange
from glrt.settings import Settings

SMALL = ["--width", "24", "--height", "16", "--samples", "64"]


def one_paragraph(text: str) -> str:
    assert text.startswith("glrt: ")
    assert text.count("\n") == 1
    assert "Traceback" not in text
    return text


# --- files -----------------------------------------------------------------------------------

KILLED_IN_SAVE = """
import os, signal, sys
from tests.support.images import picture
from glrt.core import files
def die(*_):
    os.kill(os.getpid(), signal.SIGKILL)
setattr(files if sys.argv[2] == "_rename" else os, sys.argv[2], die)
picture(64, 64).save(sys.argv[1])
"""


@pytest.mark.parametrize("moment", ["_rename", "fsync", "replace"])
@pytest.mark.parametrize("suffix", [".exr", ".png", ".npy"])
def test_a_process_killed_while_it_saves_leaves_the_old_file(
    tmp_path: Path, suffix: str, moment: str
) -> None:
    """At worst a hidden file lies next to it: the new one, never under its name."""
    path = tmp_path / f"a{suffix}"
    path.write_text("the old file")
    done = subprocess.run([sys.executable, "-c", KILLED_IN_SAVE, str(path), moment])
    assert done.returncode == -9
    assert path.read_text() == "the old file"
    others = [other.name for other in tmp_path.iterdir() if other != path]
    assert all(name.startswith(".glrt-") for name in others)


def test_a_folder_removed_during_a_render_costs_no_picture(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """The picture is saved in the folder for temporary files, and the message says where."""
    folder, temporary = tmp_path / "pictures", tmp_path / "temporary"
    folder.mkdir()
    temporary.mkdir()
    monkeypatch.setattr(tempfile, "tempdir", str(temporary))
    work = Renderer._work

    def remove(self: Renderer, remaining: int, policy: DispatchPolicy) -> None:
        if folder.exists():
            folder.rmdir()
        work(self, remaining, policy)

    monkeypatch.setattr(Renderer, "_work", remove)
    assert main(["render", "sky", *SMALL, "-o", str(folder / "a.png")]) == 4
    said = one_paragraph(capsys.readouterr().err)
    (saved,) = temporary.iterdir()
    assert str(saved) in said
    assert Image.load(saved).samples == 64


# --- the driver ------------------------------------------------------------------------------


def test_no_memory_for_a_film_exits_4_before_it_renders(tmp_path: Path) -> None:
    """16,384 pixels squared would take 25 GB; the process may have 3."""
    command = (
        f'ulimit -v 3000000; exec "{sys.executable}" -m glrt render sky -o "{tmp_path}/a.exr" '
        "--width 16384 --height 16384 --samples 1"
    )
    done = subprocess.run(["bash", "-c", command], capture_output=True, text=True)
    assert done.returncode == 4
    assert "the driver refuses a film of 16384 x 16384" in one_paragraph(done.stderr)
    assert not list(tmp_path.iterdir())


@pytest.fixture
def starved(monkeypatch: pytest.MonkeyPatch) -> None:
    """Copying a film into memory fails, as for a picture of gigabytes."""

    def refuse(_: Renderer) -> Image:
        raise MemoryError("Unable to allocate 4.00 GiB for an array")

    monkeypatch.setattr(Renderer, "image", refuse)


@pytest.mark.usefixtures("starved")
def test_no_memory_for_a_picture_exits_4_with_advice(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["render", "sky", *SMALL, "-o", str(tmp_path / "a.exr")]) == 4
    said = one_paragraph(capsys.readouterr().err)
    assert "out of memory: there is no room for 4.00 GiB" in said
    assert "--crop" in said


@pytest.mark.usefixtures("starved")
def test_no_memory_for_a_save_is_reported_while_there_is_time(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(autosave, "INTERVAL", 0.0)
    main(["render", "sky", *SMALL, "-o", str(tmp_path / "a.exr")])
    assert "No memory to save the picture" in capsys.readouterr().err


def test_a_kernel_that_the_driver_refuses_exits_4_with_file_and_line(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    read = glsl.read
    broken = read("lights/sampling.glsl") + "\nconst int BROKEN = nonsense;\n"
    monkeypatch.setattr(
        glsl, "read", lambda name: broken if name == "lights/sampling.glsl" else read(name)
    )
    assert main(["render", "sky", *SMALL, "-o", str(tmp_path / "a.png")]) == 4
    said = one_paragraph(capsys.readouterr().err)
    assert f"lights/sampling.glsl:{broken.count(chr(10))}" in said
    assert "nonsense" in said
    assert not list(tmp_path.iterdir())


@pytest.fixture
def resets(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """The driver's status of the context after each dispatch: 0 when the list is empty."""
    fates: list[int] = []
    monkeypatch.setattr(
        Context, "_reset_status", property(lambda _: lambda: fates.pop(0) if fates else 0)
    )
    return fates


@pytest.mark.parametrize(
    ("status", "said"), [(0x8253, "over this render"), (0x8254, "another"), (0x8255, "own")]
)
def test_a_lost_context_is_an_error_at_once(
    context: Context, resets: list[int], status: int, said: str
) -> None:
    renderer = Renderer(load("sky"), context=context, width=16, height=16)
    renderer.render(2)
    resets += [status]
    with pytest.raises(RenderError, match=f"reset the graphics device.*{said}"):
        renderer.render(1000)
    assert not resets, "the first dispatch after it noticed"


def test_a_context_that_is_lost_after_a_save_costs_only_what_came_later(
    tmp_path: Path,
    resets: list[int],
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    path = tmp_path / "a.exr"
    monkeypatch.setattr(autosave, "INTERVAL", 0.0)
    resets += [0, 0, 0, 0, 0x8255]  # the first is that of the compilation
    words = ["--width", "24", "--height", "16", "--samples", "100000", "-o", str(path)]
    assert main(["render", "sky", *words]) == 4
    said = one_paragraph(capsys.readouterr().err)
    kept = Image.load(path).samples
    assert kept > 0
    assert f"The first {kept} samples are saved: `glrt render --resume {path}" in said
    on = tmp_path / "on.exr"
    words = ["render", "--resume", str(path), "--samples", str(kept + 1), "-o", str(on)]
    assert main(words) == 0
    assert Image.load(on).samples == kept + 1


def test_this_driver_says_that_no_context_is_lost(context: Context) -> None:
    """This shows that the driver understands the question."""
    with context.gl:
        assert context._reset_status() == 0
        assert context.gl.error == "GL_NO_ERROR"


def test_a_driver_that_does_not_know_the_question_is_not_asked() -> None:
    """GLX gives an address for any name: calling it may end the process."""

    class Old:
        version_code, extensions, finished = 430, frozenset(["GL_ARB_sync"]), 0

        def finish(self) -> None:
            self.finished += 1

    old: Any = Old()
    Context(old, "window").finish()
    assert old.finished == 1


def test_dispatches_that_take_too_long_become_smaller(
    fresh: Context, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A driver that has become a thousand times slower is given a thousandth of the work."""
    renderer = Renderer(load("sky"), context=fresh, width=64, height=64)
    planned: list[int] = []
    record = renderer._tracer.switch.schedule.record

    def slow(part: DispatchRange, _: float) -> bool:
        planned.append(part.samples * part.tiles)
        return record(part, part.samples * part.tiles * HEADLESS.limit / 40)

    monkeypatch.setattr(renderer._tracer.switch.schedule, "record", slow)
    renderer.render(4)
    assert planned[0] <= 16, "nothing is known yet"
    assert all(work <= 20 for work in planned[1:]), "half of the limit"


# --- a cache that two share --------------------------------------------------------------------

REFERENCE = """
from glrt.analysis.reference import Budget, reference_for
from glrt.gpu.context import open_context
from glrt.image.sources import load
from glrt.settings import Settings
for _ in range(3):
    reference_for(load("cornell"), Settings(width=8, height=8), open_context(), Budget(0.9, 0.1))
"""


@pytest.mark.slow
def test_two_processes_may_share_a_cache(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, context: Context
) -> None:
    """Both make the same reference at once; they leave one whole file, and nothing else."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    both = [subprocess.Popen([sys.executable, "-c", REFERENCE]) for _ in "ab"]
    assert [process.wait(timeout=250) for process in both] == [0, 0]
    (kept,) = (tmp_path / "glrt" / "references").iterdir()
    before = kept.read_bytes()
    found = reference_for(load("cornell"), Settings(width=8, height=8), context, Budget(0.9, 0.1))
    assert found.samples > 0
    assert np.isfinite(found.first).all()
    assert kept.read_bytes() == before, "it was read, not made again"


@pytest.mark.slow
def test_pictures_written_by_two_processes_at_once_are_whole(tmp_path: Path) -> None:
    """The later one stays; no reader sees a mixture."""
    path = tmp_path / "a.exr"
    write = (
        "import sys; from tests.support.images import picture\n"
        "for _ in range(10): picture(32, 32).save(sys.argv[1])"
    )
    both = [subprocess.Popen([sys.executable, "-c", write, str(path)]) for _ in "ab"]
    while any(process.poll() is None for process in both):
        if path.exists():
            assert Image.load(path).radiance.shape == (32, 32, 3)
    assert [process.returncode for process in both] == [0, 0]
    assert list(tmp_path.iterdir()) == [path]


def test_a_render_from_a_folder_that_is_gone_says_so(tmp_path: Path) -> None:
    """The working folder itself was removed under the shell."""
    gone = tmp_path / "gone"
    gone.mkdir()
    command = f'cd "{gone}"; rmdir "{gone}"; "{sys.executable}" -m glrt render sky -o a.png'
    done = subprocess.run(["bash", "-c", command], capture_output=True, text=True, cwd=tmp_path)
    assert done.returncode == 2
    one_paragraph(done.stderr)


def test_figures_that_nobody_can_write_do_not_cost_the_picture(tmp_path: Path) -> None:
    path = tmp_path / "a.exr"
    command = f'"{sys.executable}" -m glrt render sky -o "{path}" {" ".join(SMALL)} --json'
    done = subprocess.run(["bash", "-c", f"{command} > /dev/full"], capture_output=True, text=True)
    assert done.returncode == 4
    said = one_paragraph(done.stderr)
    assert "No space left" in said
    assert f"The picture is saved in {path}" in said
    assert Image.load(path).samples == 64
