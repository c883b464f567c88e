"""EXR files that are damaged: one paragraph of ours, and none of the library's own lines."""

import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from glrt.cli.main import main
from glrt.core.errors import SceneError, UsageError
from glrt.core.files import reason
from glrt.image.image import Image, read_recipe
from glrt.process import silence
from glrt.scene.images.image_files import decode_image
from tests.support.image_bytes import WHERE
from tests.support.images import recipe

DAMAGED = "its pixels are damaged, or it is cut off"


def flipped(content: bytes, place: int, count: int = 1) -> bytes:
    middle = bytes(byte ^ 0xFF for byte in content[place : place + count])
    return content[:place] + middle + content[place + count :]


DAMAGES: dict[str, tuple[Callable[[bytes], bytes], str]] = {
    "cut off in its header": (lambda c: c[:300], "its header is damaged"),
    "cut off in its pixels": (lambda c: c[: len(c) * 3 // 4], DAMAGED),
    "without its last byte": (lambda c: c[:-1], DAMAGED),
    "damaged pixels": (lambda c: flipped(c, len(c) - 900, 600), DAMAGED),
    "a channel that is no text": (lambda c: flipped(c, c.index(b"channels") + 20), DAMAGED),
    "of another version": (lambda c: flipped(c, 4), "its header is damaged"),
    "a recipe that is no text": (
        lambda c: flipped(c, c.index(b'{"scene"') + 12),
        "a text in it is damaged, or not in UTF-8",
    ),
}


@pytest.fixture
def content(tmp_path: Path) -> bytes:
    """An EXR file whose pixels are compressed."""
    pixels = np.tile(np.linspace(0, 1, 64, dtype=np.float32)[:, None], (64, 1, 3))
    Image(pixels, pixels, 12, recipe(width=64, height=64)).save(tmp_path / "whole.exr")
    return (tmp_path / "whole.exr").read_bytes()


@pytest.mark.parametrize("damage", DAMAGES)
def test_a_damaged_file_gets_one_paragraph_and_the_library_is_silent(
    damage: str, content: bytes, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    """Both a picture of a command and an image that a scene names."""
    path, (change, said) = tmp_path / "a.exr", DAMAGES[damage]
    path.write_bytes(change(content))
    with pytest.raises(UsageError) as caught:
        Image.load(path)
    assert str(caught.value).startswith(f"{path}: cannot read this image: {said}. ")
    with pytest.raises(SceneError, match="damaged"):
        decode_image(path.read_bytes(), WHERE)
    assert capfd.readouterr() == ("", "")
    for jargon in ("part", "codec", "EXR_ERR", "scanline"):
        assert jargon not in str(caught.value)


def test_the_command_says_it_once(content: bytes, tmp_path: Path) -> None:
    (tmp_path / "a.exr").write_bytes(content[: len(content) * 3 // 4])
    command = [sys.executable, "-m", "glrt", "compare", "a.exr", "a.exr"]
    path = str(Path(__file__).parents[2])
    environment = {**os.environ, "PYTHONPATH": path}
    done = subprocess.run(
        command, capture_output=True, text=True, cwd=tmp_path, env=environment, timeout=250
    )
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr == (
        f"glrt: a.exr: cannot read this image: {DAMAGED}. Copy it or render it again.\n"
    )


def test_a_recipe_that_is_no_text_is_reported_by_its_reader_too(
    content: bytes, tmp_path: Path
) -> None:
    path = tmp_path / "a.exr"
    path.write_bytes(DAMAGES["a recipe that is no text"][0](content))
    with pytest.raises(UsageError, match="a text in it is damaged, or not in UTF-8"):
        read_recipe(path)


def test_no_reason_names_a_codec() -> None:
    for action in (lambda: b"\xff".decode(), lambda: "\udcff".encode()):
        with pytest.raises(UnicodeError) as caught:
            action()
        assert "UTF-8" in reason(caught.value)
        assert "codec" not in reason(caught.value)


@pytest.mark.skipif(sys.platform != "linux", reason="other systems refuse such names")
def test_a_name_that_openexr_does_not_take_is_refused_at_once(
    tmp_path: Path, content: bytes, capsys: pytest.CaptureFixture[str]
) -> None:
    name = os.fsdecode(b"a\xff.exr")
    (tmp_path / name).write_bytes(content)
    assert main(["compare", str(tmp_path / name), str(tmp_path / name)]) == 2
    assert r"a\udcff.exr: OpenEXR takes only names in UTF-8" in capsys.readouterr().err
    assert main(["render", "sky", "-o", str(tmp_path / name)]) == 2
    assert "OpenEXR takes only names in UTF-8" in capsys.readouterr().err


# --- silence ---------------------------------------------------------------------------------


def test_our_own_words_around_a_silence_are_kept_in_order(
    capfd: pytest.CaptureFixture[str],
) -> None:
    print("before", end=" ")
    with silence.silenced():
        print("the library's")
        os.write(1, b"its own\n")
        os.write(2, b"and its errors\n")
    print("after")
    assert capfd.readouterr() == ("before after\n", "")


def test_an_error_ends_a_silence(capfd: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(ZeroDivisionError), silence.silenced():
        raise ZeroDivisionError
    os.write(2, b"heard\n")
    assert capfd.readouterr().err == "heard\n"


def test_closed_streams_stay_closed() -> None:
    code = (
        "import os; from glrt.process.silence import silenced\n"
        "os.close(1); os.close(2)\n"
        "with silenced(): pass\n"
        "os._exit(os.open('/dev/null', os.O_RDONLY))"
    )
    assert subprocess.run([sys.executable, "-c", code]).returncode == 1
