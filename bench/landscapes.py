"""Random scenes of `bench.scenes` with meshes and skies, by seed.

    python -m bench.landscapes SEED -o FILE.toml

In half of the scenes, half of the balls that are no lamps become meshes of 5,000 to 82,000
triangles. A third of the open floors lie under a clear sky with its sun, a third under an image of
the sky with a small sun, the others under a gradient.
"""

import math
import sys
import tempfile
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from bench.dice import Dice
from bench.program import at_least, exit_code_of, parser_of
from bench.scenes import Table, random_tables
from glrt.scene.files.assets import AssetFolder
from glrt.scene.files.named_images import Pixels
from glrt.scene.files.named_meshes import mesh_of_arrays
from glrt.scene.loading.scene_files import with_files
from glrt.scene.scene import Scene
from glrt.scene.scenefile.toml import parse_scene
from tests.support.meshes import blob
from tests.support.sky_images import write_exr

ROOM_PLANES = 6
LARGEST_BLOB = 1.2  # radius of a blob over that of the ball from which it is made
DETAILS = (4, 5, 6)  # subdivisions of an icosahedron
SKY_SIZE = 64, 32  # pixels of an image of the sky
_FILES = tempfile.TemporaryDirectory(prefix="glrt-landscapes-")  # images of skies
_FOLDER = Path(_FILES.name)
_OWN_DICE = 1 << 32  # added to the seed: the dice of `bench.scenes` stay as they are


def landscape(seed: int) -> Scene:
    """The scene of a seed."""
    tables, dice = random_tables(seed), Dice(seed + _OWN_DICE)
    if dice.chance(0.5):
        tables["objects"] = [_perhaps_mesh(dice, tables, item) for item in tables["objects"]]
    is_room = sum(item["shape"] == "plane" for item in tables["objects"]) == ROOM_PLANES
    kind = "" if is_room else dice.one_of(["gradient", "clear", "image"])
    if kind == "clear":
        tables |= _clear_sky(dice)
    elif kind == "gradient" and not tables["background"]:
        tables["background"] = {"bottom": [0.3, 0.25, 0.2], "top": [0.4, 0.5, 0.8]}
    elif kind == "image":
        write_exr(_FOLDER / f"sky-{seed}.exr", sky_image(_towards(dice), dice.decades(1e3, 3e4)))
        tables["background"] = {"image": f"sky-{seed}.exr"}
    where = f"seed {seed}"
    return with_files(parse_scene(tables, where), AssetFolder(_FOLDER), where)


def _perhaps_mesh(dice: Dice, tables: Table, item: Table) -> Table:
    is_lamp = tables["materials"][item["material"]]["type"] == "light"
    if item["shape"] != "sphere" or is_lamp or dice.chance(0.5):
        return item
    points, faces = blob(dice.one_of(DETAILS))
    placed = points * (item["radius"] / LARGEST_BLOB) + item["center"]
    return {"shape": "mesh", "file": mesh_of_arrays(placed, faces), "material": item["material"]}


def _towards(dice: Dice) -> tuple[float, float, float]:
    """A direction to the sun, 0.2 to 1.2 radians above the horizon."""
    height, turn = dice.within(0.2, 1.2), dice.within(0, 2 * math.pi)
    wide = math.cos(height)
    return wide * math.cos(turn), math.sin(height), wide * math.sin(turn)


def _clear_sky(dice: Dice) -> dict[str, Any]:
    sky = {"turbidity": dice.within(2, 6), "scale": dice.within(3, 10)}
    return {"background": {"sky": sky}, "sun": {"direction": _towards(dice)}}


def sky_image(towards: tuple[float, float, float], brightness: float) -> Pixels:
    """A gradient over latitude and longitude with a sun of one pixel, (H, W, 3).

    `towards` is the way to the sun, whose radiance is about `brightness`.
    """
    width, height = SKY_SIZE
    down = (np.arange(height)[:, None] + 0.5) * math.pi / height
    turn = (np.arange(width)[None] + 0.5) * 2 * math.pi / width
    away = np.stack(
        [np.sin(down) * np.cos(turn), np.cos(down) + 0 * turn, np.sin(down) * np.sin(turn)], axis=-1
    )
    share = (away[..., 1:2] + 1) / 2
    pixels: NDArray[np.float64] = (1 - share) * np.array([0.25, 0.22, 0.2]) + share * np.array(
        [0.3, 0.45, 0.8]
    )
    near = np.degrees(np.arccos(np.clip(away @ np.array(towards), -1, 1)))
    pixels[np.unravel_index(np.argmin(near), near.shape)] = brightness * np.array([1.0, 0.9, 0.75])
    found: Pixels = pixels.astype(np.float32)
    return found


def main(arguments: list[str] | None = None) -> int:
    """`python -m bench.landscapes`; returns the exit code."""
    parser = parser_of("landscapes", __doc__)
    parser.add_argument("seed", type=at_least(0), metavar="SEED", help="a whole number from 0 on")
    told = "the scene file; its meshes and images lie next to it"
    parser.add_argument("-o", dest="file", type=Path, metavar="FILE", required=True, help=told)
    parsed = parser.parse_args(arguments)
    return exit_code_of(lambda: landscape(parsed.seed).save(parsed.file))


if __name__ == "__main__":
    sys.exit(main())
