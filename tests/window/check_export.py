"""Export: pictures of any size and films, rendered by another process while the window goes on."""

import os
from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path

from imgui_bundle import imgui
from PIL import Image as Pillow

from glrt.image.image import Image, read_recipe
from glrt.view.boxes.export_box import NAME
from glrt.view.export.wishes import Wish
from tests.window.check_toolbar import sized
from tests.window.gestures import answer, press, replaced_fov
from tests.window.hand import Hand, check

CTRL, SHIFT = imgui.Key.mod_ctrl.value, imgui.Key.mod_shift.value
BOX = f"//{NAME}"


@contextmanager
def box(hand: Hand) -> Iterator[None]:
    """The box, opened by its key and closed by Escape."""
    exports = hand.window.app.exports
    hand.there(lambda: setattr(exports, "wish", Wish()))
    press(hand, imgui.Key.e, CTRL | SHIFT)
    assert exports.is_open
    hand.ctx.yield_(3)
    try:
        yield
    finally:
        hand.there(exports.cancel)
        hand.until(lambda: exports.job is None)
        hand.there(lambda: setattr(exports, "is_open", False))


def fill(hand: Hand, name: str, text: str) -> None:
    """Type a text into a box, in place of another one."""
    hand.ctx.item_click(f"{BOX}/##{name}")
    hand.ctx.key_chars_replace_enter(text)
    hand.ctx.yield_(3)


def export(hand: Hand) -> None:
    """Press the button, and wait until the other process has ended."""
    exports = hand.window.app.exports
    hand.ctx.item_click(f"{BOX}/export")
    hand.until(lambda: exports.job is None and bool(exports.told))


@check
def the_title_of_the_box_hides_the_picture_below(hand: Hand) -> None:
    with box(hand):
        window = hand.ctx.window_info(BOX).window
        assert window
        row, (left, width) = int(window.pos.y + 3), (window.pos.x, window.size.x)
        across = slice(int(left + 0.4 * width), int(left + 0.9 * width))  # right of the words
        shades = []
        for exposure in (-8.0, 8.0):
            hand.there(partial(hand.session.edit, exposure=exposure))
            hand.settle()
            shades.append(hand.screen()[row, across].astype(int))
        assert abs(shades[0] - shades[1]).max() == 0


@check
def a_picture_of_another_size_is_exported_while_the_window_goes_on(hand: Hand) -> None:
    app, file = hand.window.app, Path.cwd() / "large.exr"
    hand.there(lambda: hand.session.edit(replaced_fov(hand, 31.0)))
    hand.settle()
    with box(hand):
        fill(hand, "width", "48")
        assert app.exports.wish.height == "48", "it keeps the shape of the view"
        fill(hand, "samples", "4")
        fill(hand, "file", str(file))
        export(hand)
        assert app.exports.told == f"Saved large.exr in {Path.cwd()}"
    image = Image.load(file)
    assert image.radiance.shape == (48, 48, 3)
    assert image.recipe
    assert image.recipe.scene.camera.fov == 31.0
    assert image.samples == 4
    assert hand.session.settings.size == (40, 40)


@check
def a_jpeg_is_exported_and_replaces_a_file_when_that_is_agreed(hand: Hand) -> None:
    app, file = hand.window.app, Path.cwd() / "small.jpg"
    file.write_text("before")
    with box(hand):
        fill(hand, "samples", "2")
        fill(hand, "file", str(file))
        hand.ctx.item_click(f"{BOX}/export")
        answer(hand, "cancel")
        assert app.exports.job is None
        assert file.read_text() == "before"
        hand.ctx.item_click(f"{BOX}/export")
        answer(hand, "replace")
        hand.until(lambda: bool(app.exports.told))
    with Pillow.open(file) as picture:
        assert (picture.format, picture.size) == ("JPEG", (40, 40))


@check
def what_is_wrong_with_an_export_is_said_where_it_is_typed(hand: Hand) -> None:
    app, ctx = hand.window.app, hand.ctx
    with box(hand):
        for text in ("", "wide", "-3", "1e3", "100000"):
            fill(hand, "width", text)
            assert app.exports.problem.startswith("width: ")
            info = ctx.item_info(f"{BOX}/export")
            assert info.item_flags & imgui.ItemFlags_.disabled.value
        fill(hand, "width", "40")
        fill(hand, "file", "picture.tiff")
        assert ".png, .exr" in app.exports.problem
        fill(hand, "file", "/nowhere/picture.png")
        export(hand)
        assert "/nowhere" in app.exports.told
        assert app.exports.job is None
    read_only = Path("/proc/picture.png")
    with box(hand):
        fill(hand, "file", str(read_only))
        export(hand)
        assert "/proc" in app.exports.told


@check
def an_export_is_cancelled_and_leaves_nothing(hand: Hand) -> None:
    app, file = hand.window.app, Path.cwd() / "never.png"
    with box(hand):
        fill(hand, "samples", "100000")
        fill(hand, "file", str(file))
        hand.ctx.item_click(f"{BOX}/export")
        hand.until(lambda: app.exports.job is not None and app.exports.job.share > 0)
        assert app.exports.job
        assert app.exports.text(0.0).startswith("never.png: ")
        assert app.exports.job._process
        process = app.exports.job._process
        press(hand, imgui.Key.q, CTRL)
        answer(hand, "cancel")
        assert not app.exports.job.is_cancelled, "the window asks before it closes"
        hand.ctx.item_click(f"{BOX}/cancel")
        hand.until(lambda: app.exports.job is None)
        assert process.poll() is not None
        assert app.exports.told == "never.png: cancelled"
    assert not file.exists()


@check
def a_film_of_a_turntable_is_exported(hand: Hand) -> None:
    app, file = hand.window.app, Path.cwd() / "turn.webp"
    with box(hand):
        hand.ctx.item_click(f"{BOX}/film##what")
        hand.ctx.yield_(3)
        fill(hand, "width", "16")
        fill(hand, "samples", "1")
        fill(hand, "frames", "3")
        fill(hand, "file", str(file))
        hand.ctx.item_click(f"{BOX}/animation##motion")
        hand.ctx.yield_(2)
        assert "no animation" in app.exports.problem
        hand.ctx.item_click(f"{BOX}/turntable##motion")
        hand.ctx.yield_(2)
        export(hand)
        assert app.exports.told.startswith(f"Saved turn.webp in {Path.cwd()}. ")
        assert "all is black" in app.exports.told, "the camera goes through the walls"
        hand.ctx.item_click(f"{BOX}/picture##what")
    with Pillow.open(file) as film:
        assert (film.format, film.size) == ("WEBP", (16, 16))
    assert '"turntable": 3' in file.read_bytes().decode("latin-1")
    assert not file.with_name("turn.webp.frames").exists()


@check
def the_box_fits_a_small_window(hand: Hand) -> None:
    for size in ((500, 400), (800, 500)):
        with sized(hand, size), box(hand):
            hand.ctx.item_click(f"{BOX}/film##what")
            hand.ctx.yield_(3)
            window = hand.ctx.window_info(BOX).window
            assert window
            assert window.pos.x >= 0
            assert window.pos.x + window.size.x <= size[0]
            assert window.pos.y >= 0
            assert window.pos.y + window.size.y <= size[1]
            hand.ctx.item_click(f"{BOX}/picture##what")


@check
def the_picture_is_copied_to_the_clipboard_by_a_program_of_the_desktop(hand: Hand) -> None:
    """A program that stands in for xclip, and none."""
    messages, folder, path = hand.window.app.files.messages, Path.cwd() / "programs", os.environ
    before, display = path["PATH"], path.pop("WAYLAND_DISPLAY", None)
    folder.mkdir()
    copied = folder / "copied.png"
    try:
        path["PATH"] = str(folder)
        press(hand, imgui.Key.c, CTRL | SHIFT)
        assert "install xclip" in hand.session.problem
        program = folder / "xclip"
        program.write_text(f"#!/bin/sh\necho $* > {folder}/options\n/bin/cat > {copied}\n")
        program.chmod(0o755)
        press(hand, imgui.Key.c, CTRL | SHIFT)
        hand.until(lambda: messages.last == "Copied the picture, 40 x 40")
    finally:
        path["PATH"] = before
        if display is not None:
            path["WAYLAND_DISPLAY"] = display
    assert (folder / "options").read_text() == "-selection clipboard -t image/png -i\n"
    assert read_recipe(copied).scene.camera == hand.session.scene.camera
