"""The thumbnails of the start screen are those of the scenes that come with glrt."""

import io
import json

import numpy as np
import pytest
from PIL import Image

from bench.thumbnails import BACK, SAMPLES, fitting, framed, rendered, sheet
from glrt.core.resources import folder
from glrt.image.sources import load
from glrt.scene.scenefile.catalog import scene_names
from glrt.view.start.thumbnails import COLUMNS, FILE, TILE


def test_every_scene_has_a_thumbnail_with_its_title_and_nothing_else_has() -> None:
    with Image.open(folder("scenes") / FILE) as picture:
        titles = json.loads(picture.info["comment"])
    assert titles == {name: load(name).title or name for name in scene_names()}


def test_tiles_stand_in_rows_with_their_titles() -> None:
    colors = np.arange(COLUMNS + 1, dtype=np.uint8) * 30
    tiles = [np.full((TILE[1], TILE[0], 3), color) for color in colors]
    titles = {f"scene {color}": f"title {color}" for color in colors}
    with Image.open(io.BytesIO(sheet(tiles, titles))) as picture:
        assert json.loads(picture.info["comment"]) == titles
        codes = np.asarray(picture.convert("RGB"))
    for number, color in enumerate(colors):
        row, column = divmod(number, COLUMNS)
        middle = codes[int((row + 0.5) * TILE[1]), int((column + 0.5) * TILE[0])]
        assert np.abs(middle.astype(int) - int(color)).max() <= 2


def test_a_tile_shows_the_whole_picture_in_its_middle() -> None:
    scene = load("cornell")
    for size, wanted in (((64, 64), (168, 168)), ((640, 160), (224, 56)), ((50, 100), (84, 168))):
        width, height = size
        shaped = scene.model_copy(
            update={"render": scene.render.model_copy(update={"width": width, "height": height})}
        )
        assert fitting(shaped) == wanted
        tile = framed(np.full((wanted[1], wanted[0], 3), 200, np.uint8))
        assert tile.shape == (TILE[1], TILE[0], 3)
        assert (tile == 200).all(axis=2).sum() == wanted[0] * wanted[1]
        is_shown = tile[:, :, 0] != BACK
        assert (is_shown == is_shown[::-1, ::-1]).all()


@pytest.mark.slow
@pytest.mark.parametrize("name", ["cornell", "lamps"])
def test_the_thumbnail_of_a_scene_shows_what_a_render_shows(name: str) -> None:
    with Image.open(folder("scenes") / FILE) as picture:
        names = list(json.loads(picture.info["comment"]))
        codes = np.asarray(picture.convert("RGB")).astype(int)
    (tile,) = rendered({name: load(name)}, SAMPLES // 4)
    row, column = divmod(names.index(name), COLUMNS)
    kept = codes[row * TILE[1] :, column * TILE[0] :][: TILE[1], : TILE[0]]
    assert np.abs(kept - tile).mean() < 4  # of 255; other scenes are off by 30 and more
