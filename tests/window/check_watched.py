"""Files that another program saves: the scene and the shaders are read again."""

from functools import partial
from pathlib import Path
from typing import Any

from glrt.core.resources import folder
from tests.window.gestures import reopen
from tests.window.hand import Hand, check


@check
def a_scene_is_saved_and_read_again_when_its_file_changes(hand: Hand) -> None:
    app, file = hand.window.app, Path.cwd() / "edited.toml"
    hand.there(lambda: hand.session.edit(bounces=3))
    hand.there(partial(setattr, app.files, "scene_path", str(file)))
    hand.there(app.files.save_scene)
    hand.there(partial(app.files.open, str(file)))
    hand.settle()
    assert hand.session.settings.bounces == 3
    text = file.read_text()
    file.write_text(text.replace("[7.6, 7.2, 6.5]", "[1.0, 2.0, 3.0]"))
    hand.until(lambda: hand.session.scene.materials["lamp"].emission == (1.0, 2.0, 3.0))  # type: ignore[union-attr]
    file.write_text("nonsense")
    hand.until(lambda: "edited.toml" in hand.session.problem)
    file.write_text(text)
    hand.until(lambda: hand.session.problem == "")
    file.unlink()
    hand.until(lambda: "edited.toml is no longer there" in hand.session.problem)
    hand.there(app.files.save_again)
    hand.until(lambda: file.is_file() and hand.session.problem == "")
    reopen(hand)


@check
def a_shader_that_is_broken_on_disk_is_reported_and_the_old_kernel_goes_on(hand: Hand) -> None:
    """The files are a copy: see tests/view/test_window.py."""
    session = hand.session
    for name, word in (("integrators/path.glsl", "undeclared"), ("display.frag", "undeclared")):
        file = folder("shaders_glsl") / name
        whole = file.read_text()
        number = whole.count("\n") + 1
        restarts = session.restarts
        file.write_text(f"{whole}float broken() {{ return {word}; }}\n")
        until_reported(hand, f"{name}:{number}:")
        assert word in session.problem
        assert session.restarts == restarts
        edits: tuple[dict[str, Any], ...] = ({"seed": restarts + 5}, {"method": "nee"})
        for edit in edits:
            hand.there(partial(session.edit, **edit))
            hand.settle()
            assert session.samples > 0, "edits go on with the texts that compiled"
        file.unlink()
        hand.until(lambda: (0, 0) in hand.window.app.shaders._known)  # it is seen to be gone
        file.write_text(whole)
        hand.until(lambda: session.problem == "")
        hand.settle()
    assert hand.pixels()[..., :3].mean() > 10


def until_reported(hand: Hand, problem: str) -> None:
    hand.until(lambda: problem in hand.session.problem)
