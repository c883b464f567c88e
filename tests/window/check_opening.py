"""A large model is read by a thread, while the window goes on with the scene that is open."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from threading import Event

import pytest
from imgui_bundle import imgui

from glrt.image.sources import load_recipe
from glrt.scene.scene import Scene
from glrt.view import kernel_notes, opening
from tests.window.gestures import answer, drop, press, reopen, reported_lines
from tests.window.hand import Hand, check

CUBE = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"


@contextmanager
def held(file: Path) -> Iterator[Event]:
    """A model that takes as long to read as until the event."""
    gate, read = Event(), load_recipe
    file.write_text(CUBE)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(opening, "LARGE", 1)
        patch.setattr(opening, "load_recipe", lambda *given: gate.wait(100) and read(*given))
        patch.setattr(opening, "compile_for", lambda *_: True)  # no other process
        yield gate


@check
def the_old_scene_goes_on_while_a_large_one_is_read(hand: Hand) -> None:
    file, files = Path.cwd() / "large.obj", hand.window.app.files
    before = files.source
    with held(file) as gate:
        drop(hand, file)
        answer(hand, "open")
        with reported_lines() as lines:
            samples = hand.session.samples
            hand.until(lambda: hand.session.samples > samples + 2)
            assert "large.obj: reading; Escape cancels" in lines
        assert files.source == before
        gate.set()
        hand.until(lambda: files.source == str(file))
    hand.settle()
    assert len(hand.session.scene.meshes) == 1
    assert hand.session.problem == ""
    reopen(hand)


@check
def escape_gives_up_a_scene_that_is_read(hand: Hand) -> None:
    file, files = Path.cwd() / "given up.obj", hand.window.app.files
    before = files.source
    with held(file) as gate:
        hand.there(lambda: files.open(str(file)))
        hand.until(lambda: bool(files.aside.text))
        press(hand, imgui.Key.escape)
        assert files.aside.text == ""
        gate.set()
        hand.settle()
    assert files.source == before


@check
def a_model_that_is_opened_again_starts_no_process(hand: Hand) -> None:
    file, files, parts = Path.cwd() / "again.obj", hand.window.app.files, list[Scene]()
    with held(file) as gate, pytest.MonkeyPatch.context() as patch:
        gate.set()
        patch.setattr(kernel_notes, "SLOW", 1e9)  # on a busy machine, and with an empty cache
        patch.setenv("XDG_CACHE_HOME", str(Path.cwd()))
        patch.setattr(opening, "compile_for", lambda part, _: parts.append(part[0]))
        for _ in range(2):
            hand.there(lambda: files.open(str(file)))
            hand.until(lambda: files.source == str(file))
            hand.settle()
            hand.until(lambda: files.aside.note is None)
            reopen(hand)
            hand.settle()
    assert [scene.meshes for scene in parts] == [parts[0].meshes]
