"""No words of a library's exception reach a user: what says so, and what of it is left."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from glrt.core.errors import ContentError, GlrtError, of_content
from glrt.core.files import reason
from glrt.image.sources import load
from glrt.scene.files.named_grids import decode_grid
from tests.fuzz import models
from tests.fuzz.foreign import is_foreign
from tests.scene.test_lost_looks import told
from tests.support.gltf_files import Builder

THROWN: list[Exception] = [
    IndexError("list index out of range"),
    ModuleNotFoundError("No module named 'charset_normalizer'"),
    AttributeError("'NoneType' object has no attribute 'get'"),
    ValueError("cannot reshape array of size 3 into shape (2,2)"),
    SyntaxError("broken PNG file"),
    OSError("image file is truncated (3 bytes not processed)"),
    RuntimeError("OpenEXR::Foo: std::bad_alloc"),
]


@pytest.mark.parametrize("error", THROWN, ids=lambda error: type(error).__name__)
def test_words_of_libraries_are_known_and_left_out(error: Exception) -> None:
    assert is_foreign(str(error))
    for words in (of_content(error), reason(error)):
        assert words
        assert not is_foreign(words)


def test_words_of_readers_and_of_the_system_stay() -> None:
    assert of_content(ContentError("triangle 3 has no corner.")) == "triangle 3 has no corner"
    assert reason(ContentError("a run passes its end")) == "a run passes its end"
    assert reason(FileNotFoundError(2, "No such file or directory")) == "No such file or directory"
    assert (
        reason(MemoryError("Unable to allocate 3.00 GiB for x")) == "there is no room for 3.00 GiB"
    )
    assert reason(EOFError("x")) == reason(OSError("image file is truncated")) == "it is cut off"


def test_files_from_which_faults_are_made_are_sound(tmp_path: Path) -> None:
    wholes = [(suffix, text.encode()) for suffix, text in models.whole_texts().items()]
    builder = models.whole_gltf()
    for case in (*wholes, (".glb", builder.glb()), (".gltf", builder.gltf())):
        assert models.check_model(case, tmp_path) == "read", case[0]
    for case in models.whole_images().items():
        assert models.check_image(case) == "read", case[0]


def without(builder: Builder, place: str, value: Any) -> bytes:
    *path, last = place.split(".")
    table: Any = builder.json
    for step in path:
        table = table[int(step)] if step.isdigit() else table[step]
    table[last] = value
    return builder.glb()


def test_a_spot_that_is_no_table_is_refused(tmp_path: Path) -> None:
    content = without(models.whole_gltf(), "extensions.KHR_lights_punctual.lights.0.spot", [1])
    (tmp_path / "thing.glb").write_bytes(content)
    with pytest.raises(GlrtError, match=r"lights\[0\]\.spot must be a table"):
        load(tmp_path / "thing.glb")


def test_an_image_whose_buffer_is_a_list_is_left_out(tmp_path: Path) -> None:
    content = without(models.whole_gltf(), "bufferViews.0.buffer", [0])
    (tmp_path / "thing.glb").write_bytes(content)
    (lost,) = told(load(tmp_path / "thing.glb"))
    assert "'thing.glb#0', which cannot be read" in lost


def test_a_grid_whose_header_is_no_python_is_refused() -> None:
    header = b"{'descr': '<f4', 'fortran_order': False, 'shape3, 4), }".ljust(117) + b"\n"
    content = b"\x93NUMPY\1\0" + np.uint16(len(header)).tobytes() + header + bytes(48)
    with pytest.raises(ValueError, match=r"no \.npy file of a grid"):
        decode_grid(content)


def test_a_mistake_in_json_is_shown_by_its_place(tmp_path: Path) -> None:
    text = json.dumps({"asset": {"version": "2.0"}}, indent=1).replace('"2.0"', "two")
    (tmp_path / "thing.gltf").write_text(text)
    with pytest.raises(GlrtError, match=r"wrong in line 3, column 14, at 'two'"):
        load(tmp_path / "thing.gltf")
