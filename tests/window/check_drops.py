"""Files dropped by another program, as the X server brings them."""

import subprocess
import sys
from pathlib import Path
from typing import Any

import glfw
import numpy as np

from glrt.scene.scenefile.toml import read_scene
from tests.support.image_bytes import COLOR, flat_hdr, png
from tests.window.gestures import answer, ball, place_of, reopen
from tests.window.hand import Hand, check


def dropped(hand: Hand, file: Path) -> int:
    """Drop it by the protocol XDND, from a process of its own; its exit code."""
    library: Any = glfw
    window = hand.there(lambda: library.get_x11_window(glfw.get_current_context()))
    command = [sys.executable, "-m", "tests.window.xdnd", str(window), str(file)]
    with subprocess.Popen(command) as source:
        hand.until(lambda: source.poll() is not None)
    return int(source.returncode)


@check
def a_scene_dropped_by_another_program_is_opened(hand: Hand) -> None:
    """Its name has what a URI writes otherwise."""
    file = Path.cwd() / "dropped, 50 % blå.toml"
    file.write_text((Path.cwd() / "scenes" / "lamps.toml").read_text())
    assert dropped(hand, file) == 0
    hand.until(lambda: hand.window.app.files.source == str(file))
    hand.settle()
    assert hand.session.scene.objects == read_scene(file).objects
    reopen(hand)


@check
def an_image_of_the_sky_dropped_by_another_program_lights_the_scene(hand: Hand) -> None:
    file = Path.cwd() / "dusk.hdr"
    file.write_bytes(flat_hdr(np.full((2, 4, 4), 130, np.uint8)))
    walls = hand.session.scene
    scene = walls.model_copy(update={"objects": walls.objects[5:]})  # planes let no light in
    hand.there(lambda: hand.session.edit(scene))
    hand.settle()
    before = hand.pixels()
    assert dropped(hand, file) == 0
    hand.until(lambda: hand.session.scene is not scene)
    hand.settle()
    image = hand.session.scene.background.image
    assert image
    assert image.file == file.name
    assert not hand.session.problem
    assert (hand.pixels() > before).mean() > 0.5
    assert hand.window.app.session.undoes == "Undo: background"
    hand.there(hand.session.undo)
    assert hand.session.scene is scene
    file.unlink()


@check
def an_image_dropped_on_an_object_becomes_its_color(hand: Hand) -> None:
    """By another program; next to the picture it is refused."""
    app, file = hand.window.app, Path.cwd() / "blue, 50 %.png"
    file.write_bytes(png(np.full((2, 2, 3), (0, 0, 255), np.uint8), COLOR))
    number, shape = ball(hand)
    before = hand.session.scene
    hand.ctx.mouse_move_to_pos(place_of(hand, shape.center))
    hand.ctx.yield_(2)
    assert dropped(hand, file) == 0
    hand.until(lambda: hand.session.scene is not before)
    hand.settle()
    material: Any = hand.session.scene.materials[hand.session.scene.objects[number].material]
    assert material.color_map.image.file == file.name
    assert app.selected == number
    assert app.messages.last.startswith("blue, 50 %.png is the color of ")
    hand.there(app.undo)
    assert hand.session.scene is before
    app.select(None)
    hand.ctx.mouse_move("//Controls/samples")
    assert dropped(hand, file) == 0
    hand.until(lambda: "where no object is" in hand.session.problem)
    assert hand.session.scene is before


@check
def a_scene_dropped_on_edits_is_opened_when_that_is_agreed(hand: Hand) -> None:
    file = Path.cwd() / "later.toml"
    file.write_text((Path.cwd() / "scenes" / "lamps.toml").read_text())
    hand.there(lambda: hand.window.app.add("box"))
    edited = hand.session.scene
    assert dropped(hand, file) == 0
    answer(hand, "cancel")
    assert hand.session.scene is edited
    assert dropped(hand, file) == 0
    answer(hand, "do not save")
    hand.until(lambda: hand.window.app.files.source == str(file))
    reopen(hand)
