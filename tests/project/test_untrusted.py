"""Scenes from strangers are data: whatever lies at the path, the answer is a scene or a paragraph.

A file that would take a minute or gigabytes to read is refused. Memory is limited: a guard that
fails shows as MemoryError and not as a machine that swaps.
"""

import os
import struct
import subprocess
import sys
import zlib
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from glrt.core.errors import GlrtError, SceneError, UsageError
from glrt.image.image import Image, read_recipe
from glrt.scene.scene import Scene
from glrt.scene.scenefile import toml
from glrt.scene.scenefile.toml import LARGEST, read_scene
from tests.support.bad_scenes import GOOD_SCENE
from tests.support.processes import glrt

MEMORY = 2 << 30  # bytes of address space
HELD_DOWN = f"""
import resource, sys
from pathlib import Path
from glrt.core.errors import UsageError
from glrt.image.sources import load
resource.setrlimit(resource.RLIMIT_AS, ({MEMORY}, {MEMORY}))
for source in sys.argv[1:]:
    try:
        load(Path(source))
    except UsageError as error:
        print(error)
"""


def refusals(*paths: Path) -> list[str]:
    """The messages of `load` for files, in one process that has little memory and time."""
    command = [sys.executable, "-c", HELD_DOWN, *map(str, paths)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=250)
    assert done.returncode == 0, done.stderr[-2000:]
    said = done.stdout.splitlines()
    assert len(said) == len(paths), "one paragraph each"
    assert all(str(path) in text for path, text in zip(paths, said, strict=True))
    return said


# --- what is no file -------------------------------------------------------------------------


def test_pipes_are_refused_though_nobody_writes_into_them(tmp_path: Path) -> None:
    pipes = [tmp_path / f"pipe{suffix}" for suffix in ("", ".toml", ".exr", ".png")]
    for pipe in pipes:
        os.mkfifo(pipe)
    assert all("a pipe or a device" in text for text in refusals(*pipes))


def test_devices_without_an_end_are_refused_and_links_to_them(tmp_path: Path) -> None:
    links = [tmp_path / name for name in ("scene.toml", "scene.exr", "scene.png")]
    for link in links:
        link.symlink_to("/dev/zero")
    said = refusals(Path("/dev/zero"), Path("/dev/full"), Path("/dev/random"), *links)
    assert all("a pipe or a device" in text for text in said)


@pytest.mark.slow
def test_a_device_as_scene_or_array_exits_2(tmp_path: Path) -> None:
    (tmp_path / "a.npy").symlink_to("/dev/zero")
    for line in (
        f"render /dev/zero -o {tmp_path}/a.png",
        f"compare {tmp_path}/a.npy {tmp_path}/a.npy --samples 4",
    ):
        done = glrt(*line.split())
        assert done.returncode == 2
        assert "a pipe or a device" in done.stderr
        assert done.stderr.count("\n") == 1


# --- scene files -----------------------------------------------------------------------------


def test_the_largest_scene_file_is_read_and_no_larger_one(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert LARGEST == 32 << 20
    monkeypatch.setattr(toml, "LARGEST", 1 << 20)
    path = tmp_path / "padded.toml"
    path.write_text(GOOD_SCENE + "#" * ((1 << 20) - len(GOOD_SCENE)))
    assert read_scene(path).objects
    with path.open("a") as file:
        file.write("#")
    with pytest.raises(SceneError, match=r"padded\.toml.*longer than 1 MiB"):
        read_scene(path)


def test_a_file_without_end_is_not_read_to_its_end(tmp_path: Path) -> None:
    path = tmp_path / "sparse.toml"
    with path.open("wb") as file:
        file.truncate(1 << 40)
    assert "longer than 32 MiB" in refusals(path)[0]


LONG_KEYS = {
    "bare": "x" + ".x" * 40_000 + " = 1",
    "spaced": "title = 'x'\nx" + " . x" * 40_000 + " = 1",
    "quoted": '"x"' + '."x"' * 40_000 + " = 1",
    "literal": "'x'" + ".'x'" * 40_000 + " = 1",
    "mixed": "x" + ".x.'.'" * 20_000 + " = 1",
    "table": "[x" + ".x" * 40_000 + "]",
    "inline": "x = {x" + ".x" * 40_000 + " = 1}",
}


def test_keys_of_many_parts_are_refused_before_they_are_parsed(tmp_path: Path) -> None:
    """tomllib would take a minute and 6 GB for each."""
    paths = [tmp_path / f"{name}.toml" for name in LONG_KEYS]
    for path, key in zip(paths, LONG_KEYS.values(), strict=True):
        path.write_text(key)
    assert all("a key of 64 parts in line" in text for text in refusals(*paths))


@pytest.mark.slow
def test_long_words_and_many_quotes_do_not_slow_the_search_for_long_keys(tmp_path: Path) -> None:
    """A search that tried every end of every word would take hours."""
    path = tmp_path / "words.toml"
    words = "a" * 500_000 + "\n" + '"' * 500_000 + "\n" + ("a." * 60 + ",") * 5000
    path.write_text(f"title = '''{words}'''")
    assert "camera is missing" in refusals(path)[0]


def test_deep_values_are_refused(tmp_path: Path) -> None:
    paths = [tmp_path / f"{i}.toml" for i in range(3)]
    for path, text in zip(paths, ("[" * 100_000, "{a=" * 100_000, "[[1]," * 50_000), strict=True):
        path.write_text(f"x = {text}")
    assert all("nested too deeply" in text for text in refusals(*paths))


@pytest.mark.slow
def test_more_mistakes_than_can_be_reported_are_counted(tmp_path: Path) -> None:
    path = tmp_path / "wrong.toml"
    path.write_text("objects = [" + "[]," * 150_000 + "]")
    assert "150,001 mistakes" in refusals(path)[0]


# --- pictures --------------------------------------------------------------------------------


def png(*chunks: tuple[bytes, bytes]) -> bytes:
    """A grey pixel with other chunks before it."""
    header = (b"IHDR", struct.pack(">IIBBBBB", 1, 1, 8, 0, 0, 0, 0))
    body = (b"IDAT", zlib.compress(b"\0\0")), (b"IEND", b"")
    parts = [
        struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
        for kind, data in (header, *chunks, *body)
    ]
    return b"\x89PNG\r\n\x1a\n" + b"".join(parts)


BOMB = zlib.compress(bytes(400_000_000), 9)


def test_metadata_that_unpack_to_hundreds_of_megabytes_are_refused(tmp_path: Path) -> None:
    chunks = {"zTXt": b"glrt\0\0", "iTXt": b"glrt\0\1\0\0\0"}
    paths = [tmp_path / f"{kind}.png" for kind in chunks]
    for path, (kind, head) in zip(paths, chunks.items(), strict=True):
        path.write_bytes(png((kind.encode(), head + BOMB)))
        assert path.stat().st_size < 1e6
    refusals(*paths)


@pytest.mark.slow
def test_recipes_that_are_deep_or_long_are_refused(tmp_path: Path) -> None:
    recipes = {
        "deep": '{"scene":' * 100_000,
        "long": '{"scene": {"title": "' + "x" * LARGEST + '"}}',
    }
    paths = []
    for name, suffix in product(recipes, (".png", ".exr")):
        paths.append(tmp_path / f"{name}{suffix}")
        write_with_recipe(paths[-1], recipes[name])
    assert all("is damaged" in text for text in refusals(*paths))


def write_with_recipe(path: Path, text: str) -> None:
    """A picture of one pixel whose recipe is any text."""
    if path.suffix == ".png":
        path.write_bytes(png((b"iTXt", b"glrt\0\0\0\0\0" + text.encode())))
        return
    import OpenEXR  # type: ignore[import-not-found]

    pixel = np.zeros((1, 1, 3), np.float32)
    OpenEXR.File({"glrt": text}, {"RGB": pixel}).write(str(path))


def test_an_exr_that_claims_a_recipe_of_gigabytes_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "claim.exr"
    claim = b"glrt\0string\0" + struct.pack("<i", 0x7FFFFFFF)
    path.write_bytes(b"\x76\x2f\x31\x01\x02\0\0\0" + claim + b"{}")
    assert "claim.exr" in refusals(path)[0]


def test_an_exr_that_claims_a_trillion_pixels_is_refused_by_its_header(tmp_path: Path) -> None:
    path = tmp_path / "vast.exr"
    pixel = np.zeros((1, 1, 3), np.float32)
    Image(pixel, pixel, samples=0).save(path)
    window = b"dataWindow\0box2i\0" + struct.pack("<i", 16)
    content = path.read_bytes()
    at = content.index(window) + len(window)
    vast = content[:at] + struct.pack("<4i", 0, 0, 999_999, 999_999) + content[at + 16 :]
    path.write_bytes(vast)
    with pytest.raises(UsageError, match=r"vast\.exr: 1000000 x 1000000 pixels"):
        Image.load(path)
    with pytest.raises(GlrtError, match=r"vast\.exr"):
        read_recipe(path)


def test_the_keys_of_a_scene_that_are_paths_are_known() -> None:
    """The rest are numbers and names. Paths go through scene/assets.py."""
    assert texts_of(Scene.model_json_schema()) == {
        *(
            "title",
            "name",
            "material",
            "medium",
            "group",
            "image",
            "file",
            "grid",
            "node",
            "part",
            "target",
            "animation",
            "variant",
        ),
    }


def texts_of(schema: Any) -> set[str]:
    """The keys of a JSON schema whose values may be any text."""
    if isinstance(schema, list):
        return set().union(*map(texts_of, schema))
    if not isinstance(schema, dict):
        return set()
    found = {key for key, value in schema.get("properties", {}).items() if is_text(value)}
    return found.union(*map(texts_of, schema.values()))


def is_text(schema: dict[str, Any]) -> bool:
    kinds = [schema, *schema.get("anyOf", [])]
    return any(k.get("type") == "string" and not {"const", "enum"} & k.keys() for k in kinds)
