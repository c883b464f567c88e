"""Files are written whole or not at all, and places that cannot be written are refused early."""

import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from glrt.core.errors import GlrtError, RenderError, UsageError
from glrt.core.files import write_text
from glrt.image.image import Image, check_writable
from tests.support.images import picture, same_bits

every_suffix = pytest.mark.parametrize("suffix", [".exr", ".png", ".npy"])


@pytest.fixture
def image() -> Image:
    return picture()


@pytest.fixture
def umask() -> Iterator[int]:
    before = os.umask(0o027)
    yield 0o027
    os.umask(before)


@every_suffix
def test_new_files_have_the_permissions_of_any_new_file(
    tmp_path: Path, image: Image, umask: int, suffix: str
) -> None:
    image.save(tmp_path / f"x{suffix}")
    assert (tmp_path / f"x{suffix}").stat().st_mode & 0o777 == 0o666 & ~umask


@every_suffix
def test_an_older_file_keeps_its_permissions(tmp_path: Path, image: Image, suffix: str) -> None:
    path = tmp_path / f"x{suffix}"
    path.touch()
    path.chmod(0o640)
    image.save(path)
    assert path.stat().st_mode & 0o777 == 0o640
    assert path.stat().st_size > 0


def test_a_link_stays_and_its_file_is_written(tmp_path: Path, image: Image) -> None:
    (tmp_path / "there").mkdir()
    (tmp_path / "x.npy").symlink_to(tmp_path / "there" / "real.npy")
    image.save(tmp_path / "x.npy")
    assert (tmp_path / "x.npy").is_symlink()
    assert same_bits(np.load(tmp_path / "there" / "real.npy"), image.radiance)


@every_suffix
def test_nothing_is_left_next_to_the_file(tmp_path: Path, image: Image, suffix: str) -> None:
    image.save(tmp_path / f"x{suffix}")
    image.save(tmp_path / f"x{suffix}")
    assert [path.name for path in tmp_path.iterdir()] == [f"x{suffix}"]


def assert_untouched(folder: Path, name: str) -> None:
    assert [path.name for path in folder.iterdir()] == [name]
    assert (folder / name).read_text() == "the old file"


@every_suffix
def test_a_failed_rename_leaves_the_old_file_and_no_other(
    tmp_path: Path, image: Image, suffix: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(*_: object) -> None:
        raise OSError(28, "No space left on device")

    path = tmp_path / f"x{suffix}"
    path.write_text("the old file")
    monkeypatch.setattr(os, "replace", refuse)
    with pytest.raises(RenderError, match=rf"x\{suffix}: No space left on device"):
        image.save(path)
    assert_untouched(tmp_path, path.name)


FULL_DISK = """
import resource, sys
from pathlib import Path
import numpy as np
from glrt.core.errors import RenderError
from glrt.image.image import Image
pixels = np.random.default_rng(1).random((64, 64, 3), np.float32)
image = Image(pixels, pixels, 1)
resource.setrlimit(resource.RLIMIT_FSIZE, (int(sys.argv[2]),) * 2)
for suffix in (".exr", ".png", ".npy"):
    try:
        image.save(Path(sys.argv[1]) / f"x{suffix}")
    except RenderError as error:
        print(error)
"""


@pytest.mark.parametrize("limit", [0, 2000])
def test_a_full_disk_leaves_the_old_files_and_no_others(tmp_path: Path, limit: int) -> None:
    names = ["x.exr", "x.npy", "x.png"]
    for name in names:
        (tmp_path / name).write_text("the old file")
    command = [sys.executable, "-c", FULL_DISK, str(tmp_path), str(limit)]
    run = subprocess.run(command, capture_output=True, text=True, check=True)
    assert len(run.stdout.splitlines()) == 3
    assert run.stdout.count("Cannot write") == 3
    assert sorted(path.name for path in tmp_path.iterdir()) == names
    assert {path.read_text() for path in tmp_path.iterdir()} == {"the old file"}


def test_an_interrupted_save_leaves_nothing(
    tmp_path: Path, image: Image, monkeypatch: pytest.MonkeyPatch
) -> None:
    def interrupt(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(np, "save", interrupt)
    with pytest.raises(KeyboardInterrupt):
        image.save(tmp_path / "x.npy")
    assert list(tmp_path.iterdir()) == []


def test_a_folder_that_is_missing_fails_the_save(tmp_path: Path, image: Image) -> None:
    with pytest.raises(RenderError, match=r"missing/x\.png: No such file or directory"):
        image.save(tmp_path / "missing" / "x.png")


@pytest.mark.parametrize("path", ["/", ".", "x\0.toml", "x" * 5000])
def test_what_no_file_can_be_called_fails_the_save(path: str) -> None:
    with pytest.raises(RenderError, match="Cannot write"):
        write_text(Path(path), "text")


@pytest.mark.parametrize("name", ["x.jpg", "x", "x.png.txt", ".png"])
def test_an_unknown_suffix_is_refused_with_the_three_known(
    tmp_path: Path, image: Image, name: str
) -> None:
    for refuse in (check_writable, image.save):
        with pytest.raises(UsageError, match=r"end in \.exr, \.png or \.npy"):
            refuse(tmp_path / name)
    assert list(tmp_path.iterdir()) == []


@every_suffix
def test_a_writable_place_is_left_as_it_was(tmp_path: Path, suffix: str) -> None:
    check_writable(tmp_path / f"new{suffix.upper()}")
    assert list(tmp_path.iterdir()) == []
    old = tmp_path / f"old{suffix}"
    old.write_text("the old file")
    os.utime(old, (1, 1))
    check_writable(old)
    assert_untouched(tmp_path, old.name)
    assert old.stat().st_mtime == 1


def test_places_that_cannot_be_written_are_refused(tmp_path: Path) -> None:
    (tmp_path / "folder.png").mkdir()
    (tmp_path / "file").touch()
    (tmp_path / "loop.png").symlink_to(tmp_path / "loop.png")
    before = sorted(tmp_path.iterdir())
    names = ["missing/x.png", "folder.png", "file/x.png", "loop.png", "x" * 300 + ".png", "a\0.png"]
    for name in names:
        with pytest.raises(UsageError, match="Cannot write") as caught:
            check_writable(tmp_path / name)
        assert "\n" not in str(caught.value)
    assert sorted(tmp_path.iterdir()) == before


@pytest.mark.skipif(not Path("/proc/self").is_dir(), reason="needs /proc")
def test_a_folder_that_refuses_even_root_is_found_by_trying() -> None:
    with pytest.raises(UsageError, match=r"Cannot write /proc/self/x\.png"):
        check_writable("/proc/self/x.png")


def test_a_folder_closed_to_the_user_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def closed(*_: object) -> int:
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(os, "open", closed)
    with pytest.raises(UsageError, match=r"x\.png: Permission denied") as caught:
        check_writable(tmp_path / "x.png")
    assert isinstance(caught.value, GlrtError)
    assert caught.value.exit_code == 2
