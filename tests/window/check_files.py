"""Files: pictures, recipes and scenes, saved and opened by name, clipboard and dialog."""

import os
from functools import partial
from pathlib import Path

from imgui_bundle import imgui

from glrt.image.image import read_recipe
from glrt.image.sources import load
from glrt.scene.toml import read_scene
from glrt.view import file_dialogs
from tests.window.gestures import reopen, replaced_fov
from tests.window.hand import SMALL, Hand, check


@check
def a_picture_is_saved_with_its_recipe_and_opened_again(hand: Hand) -> None:
    app = hand.window.app
    for suffix in ("png", "exr"):
        file = Path.cwd() / f"saved.{suffix}"
        hand.begin()
        hand.there(lambda: hand.session.edit(replaced_fov(hand, 25.0), samples=3))
        hand.until(lambda: hand.session.is_done)
        hand.there(partial(setattr, app.files, "picture_path", str(file)))
        hand.there(app.files.save_picture)
        hand.begin()
        hand.there(partial(app.files.open, str(file)))
        hand.settle()
        assert (hand.session.scene.camera.fov, hand.session.settings.samples) == (25.0, 3)
        reopen(hand)


@check
def a_recipe_is_copied_and_pasted(hand: Hand) -> None:
    hand.ctx.item_open("//Controls/Files")
    hand.there(lambda: hand.session.edit(replaced_fov(hand, 31.0), bounces=2, exposure=1.5))
    hand.settle()
    hand.ctx.item_click("//Controls/copy recipe")
    hand.begin()
    hand.ctx.item_click("//Controls/paste recipe")
    hand.settle()
    settings = hand.session.settings
    assert (hand.session.scene.camera.fov, settings.bounces, settings.exposure) == (31.0, 2, 1.5)
    hand.there(lambda: imgui.set_clipboard_text("no recipe"))
    hand.ctx.item_click("//Controls/paste recipe")
    assert hand.session.problem.startswith("The clipboard")
    reopen(hand)


@check
def dialogs_of_the_desktop_open_and_save(hand: Hand) -> None:
    """A program that stands in for zenity: it answers what a file says."""
    app, folder, path = hand.window.app, Path.cwd() / "dialogs", os.environ["PATH"]
    folder.mkdir()
    answer, program = folder / "answer", folder / "zenity"
    program.write_text(f"#!/bin/sh\nuntil [ -s {answer} ]; do sleep 0.02; done\ncat {answer}\n")
    program.chmod(0o755)
    os.environ["PATH"] = f"{folder}:{path}"
    hand.ctx.item_open("//Controls/Files")
    hand.ctx.set_ref("Controls")

    def choose(button: str, file: Path) -> None:
        answer.unlink(missing_ok=True)
        hand.ctx.item_click(button)
        samples = hand.session.samples
        hand.until(lambda: hand.session.samples > samples)
        assert app.files.dialogs.is_open
        (folder / "new").write_text(f"{file}\n")
        (folder / "new").rename(answer)
        hand.until(lambda: not app.files.dialogs.is_open)

    try:
        choose("...##scene file", folder / "cornell.toml")
        assert read_scene(folder / "cornell.toml") == hand.session.scene.model_copy(
            update={"render": hand.session.scene.render.model_copy(update=SMALL)}
        )
        choose("...##save", folder / "shot.exr")
        assert read_recipe(folder / "shot.exr").scene == hand.session.scene
        choose("...##open", folder / "shot.exr")
        assert app.files.source == str(folder / "shot.exr")
        hand.ctx.item_click("...##open")
        hand.there(app.files.dialogs.close)
        assert not app.files.dialogs.is_open
    finally:
        os.environ["PATH"] = path
        hand.there(app.files.dialogs.close)
    reopen(hand)


@check
def without_dialogs_the_boxes_serve(hand: Hand) -> None:
    app, ctx, before = hand.window.app, hand.ctx, file_dialogs.PROGRAMS
    file_dialogs.PROGRAMS = ()  # type: ignore[assignment]
    ctx.item_open("//Controls/Files")
    ctx.yield_(2)
    assert not ctx.item_exists("//Controls/...##open")
    ctx.item_click("//Controls/##scene file")
    ctx.key_chars_replace_enter(str(Path.cwd() / "typed.toml"))
    ctx.yield_(2)
    assert read_scene(Path.cwd() / "typed.toml") == load("cornell").model_copy(
        update={"render": load("cornell").render.model_copy(update=SMALL)}
    )
    file_dialogs.PROGRAMS = before
    assert app.messages.last.startswith("Saved")
    reopen(hand)


@check
def what_cannot_be_saved_is_told(hand: Hand) -> None:
    hand.there(partial(setattr, hand.window.app.files, "picture_path", "/nowhere/picture.png"))
    hand.there(hand.window.app.files.save_picture)
    assert "/nowhere" in hand.session.problem
