"""Files: pictures, recipes and scenes, saved and opened by name, clipboard and dialog."""

import os
from functools import partial
from pathlib import Path

from imgui_bundle import imgui

import glfw  # isort: skip

from glrt.image.image import read_recipe
from glrt.image.sources import load
from glrt.scene.scenefile.toml import read_scene
from glrt.view import file_dialogs
from glrt.view.state.recent import load_recent
from tests.window.gestures import answer, press, reopen, replaced_fov
from tests.window.hand import SMALL, Hand, check

CTRL, SHIFT = imgui.Key.mod_ctrl.value, imgui.Key.mod_shift.value


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
        hand.until(lambda: not app.files.writer)
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
        hand.there(app.files.finish_picture)
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


BROWSER = "//###file browser"


@check
def without_dialogs_of_the_desktop_the_window_draws_one(hand: Hand) -> None:
    files, ctx, before = hand.window.app.files, hand.ctx, file_dialogs.PROGRAMS
    file_dialogs.PROGRAMS = ()  # type: ignore[assignment]
    folder = Path.cwd() / "drawn" / "deeper"
    folder.mkdir(parents=True)
    (folder / "notes.txt").touch()
    try:
        press(hand, imgui.Key.s, CTRL)  # a scene that comes with glrt: it asks for a name
        assert files.dialogs.is_open
        fill(hand, "##folder", str(folder))
        fill(hand, "##name", "drawn")
        hand.until(lambda: not files.dialogs.is_open)
        assert read_scene(folder / "drawn.toml").objects == hand.session.scene.objects
        assert files.source == str(folder / "drawn.toml")
        press(hand, imgui.Key.s, CTRL | SHIFT)  # under a name that is there
        fill(hand, "##folder", str(folder))
        fill(hand, "##name", "notes.txt")
        answer(hand, "cancel")
        assert (folder / "notes.txt").read_text() == ""
        press(hand, imgui.Key.o, CTRL)
        fill(hand, "##folder", str(folder.parent))
        assert ctx.item_exists(f"{BROWSER}/**/deeper\\/")
        ctx.item_double_click(f"{BROWSER}/**/deeper\\/")
        assert not ctx.item_exists(f"{BROWSER}/**/notes.txt")
        ctx.yield_(2)
        ctx.item_click(f"{BROWSER}/**/drawn.toml")
        ctx.item_click(f"{BROWSER}/open")
        hand.until(lambda: files.messages.last.startswith("Opened"))
        press(hand, imgui.Key.o, CTRL)
        ctx.yield_(2)
        press(hand, imgui.Key.escape)
        hand.until(lambda: not files.dialogs.is_open)
    finally:
        file_dialogs.PROGRAMS = before
    reopen(hand)


def fill(hand: Hand, box: str, text: str) -> None:
    """A box of the dialog, to its end."""
    hand.ctx.yield_(3)
    hand.ctx.item_click(f"{BROWSER}/{box}")
    hand.ctx.key_chars_replace_enter(text)
    hand.ctx.yield_(3)


@check
def the_boxes_serve_too(hand: Hand) -> None:
    app, ctx = hand.window.app, hand.ctx
    ctx.item_open("//Controls/Files")
    ctx.yield_(2)
    ctx.item_click("//Controls/##scene file")
    ctx.key_chars_replace_enter(str(Path.cwd() / "typed.toml"))
    ctx.yield_(2)
    assert read_scene(Path.cwd() / "typed.toml") == load("cornell").model_copy(
        update={"render": load("cornell").render.model_copy(update=SMALL)}
    )
    assert app.messages.last == f"Saved typed.toml in {Path.cwd()}"
    reopen(hand)


@check
def a_scene_file_is_saved_by_its_key_with_its_comments(hand: Hand) -> None:
    app, file = hand.window.app, Path.cwd() / "own.toml"
    text = (Path.cwd() / "scenes" / "cornell.toml").read_text()
    file.write_text(text)
    hand.there(partial(app.files.open, str(file)))
    hand.there(lambda: hand.session.edit(**SMALL))
    hand.settle()
    assert title(hand) == "own.toml * - glrt"  # another size
    assert not app.files.is_changed  # but nothing is asked for that
    press(hand, imgui.Key.s, CTRL)
    assert title(hand) == "own.toml - glrt"
    hand.there(partial(app.add, "sphere"))
    hand.ctx.yield_(2)
    assert title(hand) == "own.toml * - glrt"
    press(hand, imgui.Key.s, CTRL)
    assert title(hand) == "own.toml - glrt"
    assert "# Just under the ceiling" in file.read_text()
    assert read_scene(file).objects == hand.session.scene.objects
    press(hand, imgui.Key.z, CTRL)
    assert title(hand) == "own.toml * - glrt"
    press(hand, imgui.Key.y, CTRL)
    assert title(hand) == "own.toml - glrt"
    reopen(hand)


def title(hand: Hand) -> str:
    """The window's title, as the desktop has it."""
    return str(hand.there(lambda: glfw.get_window_title(glfw.get_current_context())))


@check
def edits_are_not_lost_unasked(hand: Hand) -> None:
    files, session = hand.window.app.files, hand.session
    hand.there(lambda: session.edit(replaced_fov(hand, 30.0)))  # the camera alone is no edit
    assert not files.is_changed
    hand.there(partial(hand.window.app.add, "box"))
    edited = session.scene
    hand.there(partial(files.ask_open, "lamps"))
    answer(hand, "cancel")
    assert session.scene is edited
    hand.there(partial(files.ask_open, "lamps"))
    press(hand, imgui.Key.escape)
    assert (session.scene, files.messages.question) == (edited, None)
    hand.there(lambda: glfw.set_window_should_close(glfw.get_current_context(), True))
    answer(hand, "cancel")
    assert session.scene is edited
    own = Path.cwd() / "kept.toml"
    hand.there(partial(files.save_scene, str(own)))
    hand.there(partial(hand.window.app.add, "disk"))
    edited = session.scene
    hand.there(partial(files.ask_open, "lamps"))
    answer(hand, "save")
    assert read_scene(own).objects == edited.objects
    assert files.source == "lamps"
    reopen(hand)


@check
def pictures_get_numbers_and_replace_nothing_unasked(hand: Hand) -> None:
    files, shot = hand.window.app.files, Path.cwd() / "numbered.png"
    hand.there(partial(files.save_picture, str(shot)))
    hand.until(lambda: not files.writer)
    assert files.messages.last == f"Saved numbered.png in {Path.cwd()}"
    before = shot.read_bytes()
    for number in (2, 3):
        press(hand, imgui.Key.e, CTRL)
        hand.until(lambda: not files.writer)
        assert (Path.cwd() / f"numbered-{number}.png").exists()
    hand.there(partial(files.ask_save_picture, str(shot)))
    answer(hand, "cancel")
    assert shot.read_bytes() == before
    hand.until(lambda: hand.session.samples > 20)
    hand.there(partial(files.ask_save_picture, str(shot)))
    answer(hand, "replace")
    hand.until(lambda: not files.writer)
    assert shot.read_bytes() != before


@check
def what_was_opened_last_is_at_hand(hand: Hand) -> None:
    files, ctx = hand.window.app.files, hand.ctx
    file = Path.cwd() / "lately.toml"
    file.write_text((Path.cwd() / "scenes" / "cornell.toml").read_text())
    hand.there(partial(files.open, str(file)))
    hand.there(partial(files.open, "lamps"))
    assert files.recent[:2] == ("lamps", str(file))
    assert load_recent(files.recent_file)[:2] == files.recent[:2]
    ctx.item_open("//Controls/Files")
    ctx.item_click("//Controls/recent")
    ctx.yield_(2)
    row = f"lately.toml in {Path.cwd()}##1".replace("/", "\\/")
    ctx.item_click(f"//$FOCUSED/{row}")
    hand.settle()
    assert files.source == str(file)
    ctx.item_close("//Controls/Files")
    reopen(hand)


@check
def what_cannot_be_saved_is_reported(hand: Hand) -> None:
    hand.there(partial(setattr, hand.window.app.files, "picture_path", "/nowhere/picture.png"))
    hand.there(hand.window.app.files.save_picture)
    hand.until(lambda: not hand.window.app.files.writer)
    assert "/nowhere" in hand.session.problem
