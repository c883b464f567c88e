"""glTF files that are wrong: refused by their place, and damaged ones read or refused."""

import json
import re
import time
from typing import Any

import pytest

from glrt.core.errors import SceneError
from glrt.scene.model_files.mesh_formats import decode_mesh
from tests.scene.test_mesh_files import damaged
from tests.support.gltf_files import Builder, square, textured_square


def broken(change: str, value: Any) -> bytes:
    """A sound file with one value replaced, at a path as `accessors.0.count`."""
    builder = textured_square()
    builder.json["scenes"] = [{"nodes": [0]}]
    *path, last = change.split(".")
    place: Any = builder.json
    for step in path:
        place = place[int(step)] if step.isdigit() else place[step]
    place[int(last) if last.isdigit() else last] = value
    return builder.glb()


WRONG: dict[str, tuple[str, Any, str]] = {
    "another version": ("asset.version", "1.0", "asset.version must be 2.0, got '1.0'"),
    "a view that is not there": ("accessors.0.bufferView", 99, "names bufferViews[99]"),
    "an accessor that is not there": ("meshes.0.primitives.0.indices", 99, "accessors[99]"),
    "a mesh that is not there": ("nodes.0.mesh", -1, "names meshes[-1]"),
    "a long view": ("bufferViews.1.byteLength", 1 << 30, "ends after its buffer"),
    "a negative count": ("accessors.0.count", -4, "count must be a whole number"),
    "a huge count": ("accessors.0.count", 1 << 36, "count must be at most"),
    "a wrong type": ("accessors.0.componentType", 7, "componentType is none of"),
    "too many rows": ("accessors.0.count", 4000, "ends after its view"),
    "a circle": ("nodes.0.children", [0], "stands below itself"),
    "a wrong mode": ("meshes.0.primitives.0.mode", 9, "mode must be"),
    "no list": ("meshes.0.primitives", {}, "primitives must be a list"),
    "no number": ("nodes.0.translation", ["a", 0, 0], "translation[0] must be a number"),
    "no turn": ("nodes.0.rotation", [0, 0, 0, 0], "rotation must not be zero"),
    "a huge matrix": ("nodes.0.scale", [1e300, 1, 1], "scale[0] must be a number from"),
}


@pytest.mark.parametrize("name", WRONG)
def test_what_is_wrong_is_refused_by_its_place(name: str) -> None:
    change, value, message = WRONG[name]
    with pytest.raises(SceneError, match=r"^here: 'thing.glb' is damaged") as caught:
        decode_mesh(broken(change, value), "thing.glb", "here")
    assert message in str(caught.value)


@pytest.mark.parametrize(
    ("needed", "told"),
    [
        (["EXT_x"], "requires the extension 'EXT_x'"),
        (["KHR_x", "KHR_draco_mesh_compression"], "the extension 'KHR_x'"),
        (["EXT_meshopt_compression", 3], "the extensions 'EXT_meshopt_compression', 3"),
        ([["EXT_x"]], "the extension a list"),
    ],
)
def test_a_needed_extension_is_refused_by_its_name_and_not_as_damage(
    needed: list[Any], told: str
) -> None:
    with pytest.raises(SceneError, match=r"^here: 'thing.glb' requires the ext") as caught:
        decode_mesh(broken("extensionsRequired", needed), "thing.glb", "here")
    assert told in str(caught.value)
    assert "damaged" not in str(caught.value)


@pytest.mark.parametrize("name", ["KHR_xmp_json_ld", "EXT_structural_metadata"])
def test_extensions_that_change_no_picture_are_read(name: str) -> None:
    assert decode_mesh(broken("extensionsRequired", [name]), "thing.glb", "here").faces.any()


def is_read(text: str) -> bool:
    try:
        return bool(len(decode_mesh(text.encode(), "a.gltf", "here").faces))
    except SceneError:
        return False


@pytest.mark.parametrize(("word", "changed"), [("4", "4.0"), ("4", "0.4e1"), ("0", "0.0")])
def test_whole_numbers_may_be_written_as_floats(word: str, changed: str) -> None:
    """https://json-schema.org/draft/2020-12/json-schema-core#name-instance-data-model"""
    builder = Builder()
    builder.shown(square(builder))
    text = builder.gltf().decode()
    number = re.compile(rf'(": |\[){word}(?=[,\]}}])')
    assert number.search(text)
    assert is_read(text)
    assert is_read(number.sub(rf"\g<1>{changed}", text))


def test_numbers_that_are_not_whole_are_refused_where_whole_ones_belong() -> None:
    with pytest.raises(SceneError, match=r"names meshes\[0.5\]"):
        decode_mesh(broken("nodes.0.mesh", 0.5), "thing.glb", "here")


ENDS: dict[str, tuple[bytes, str]] = {
    "nothing": (b"", "JSON is wrong"),
    "a header alone": (b"glTF\x02\0\0\0", "ends within its header"),
    "half a file": (textured_square().glb()[:200], "and states"),
    "nested lists": (b"[" * 100_000, "nested too deeply"),
    "a list": (b"[]", "no table"),
    "no number": (b'{"asset": {"version": NaN}}', "NaN"),
    "no base64": (
        textured_square().gltf("data:application/octet-stream;base64,???"),
        "damaged base64",
    ),
    "a data URI without data": (textured_square().gltf("data:x"), "without ';base64,'"),
    "a web address": (textured_square().gltf("https://example.org/a.bin"), "web address"),
}


@pytest.mark.parametrize("name", ENDS)
def test_files_that_are_none_are_refused(name: str) -> None:
    content, message = ENDS[name]
    with pytest.raises(SceneError) as caught:
        decode_mesh(content, "thing.gltf", "here")
    assert message in str(caught.value)
    assert "\n" not in str(caught.value)


def survives(content: bytes, seed: int) -> None:
    start, told = time.process_time(), ""
    try:
        decode_mesh(damaged(content, seed), "thing.gltf", "here")
    except SceneError as error:
        told = str(error)
    assert not told or told.startswith("here: 'thing.gltf'")
    assert time.process_time() - start < 10


def indented(builder: Builder) -> bytes:
    """The file with a line for each value: damage meets few at once."""
    return json.dumps(json.loads(builder.gltf()), indent=0).encode()


SOUND = {"glb": textured_square().glb(), "gltf": indented(textured_square())}


@pytest.mark.parametrize("kind", SOUND)
def test_damaged_files_are_read_or_refused(kind: str) -> None:
    for seed in range(150):
        survives(SOUND[kind], seed)


@pytest.mark.slow
@pytest.mark.parametrize("kind", SOUND)
def test_thousands_of_damaged_files_are_read_or_refused(kind: str) -> None:
    for seed in range(1000, 3000):
        survives(SOUND[kind], seed)


def test_a_buffer_next_to_the_file_is_read() -> None:
    builder = textured_square()
    read = decode_mesh(
        builder.gltf("a%20b.bin"), "x.gltf", "here", {"a b.bin": builder.binary}.__getitem__
    )
    assert len(read.faces) == 2
    with pytest.raises(SceneError, match="its own content is at hand"):
        decode_mesh(builder.gltf("a.bin"), "x.gltf", "here")
