"""Files that a scene names: which are read, how they are recorded, and every refusal."""

import hashlib
import os
import shutil
from pathlib import Path

import pytest

from glrt.core.errors import SceneError
from glrt.scene.files import assets
from glrt.scene.files.assets import Asset, AssetFolder, AssetReader

WHERE = "room.toml: objects[2].file"
SECRET = b"a private key"


@pytest.fixture
def base(tmp_path: Path) -> Path:
    """A folder with files, next to a file that no scene in it may read."""
    folder = tmp_path / "scene"
    (folder / "models" / "maps").mkdir(parents=True)
    (folder / "models" / "chair.obj").write_bytes(b"mtllib chair.mtl")
    (folder / "models" / "chair.mtl").write_bytes(b"map_Kd maps/wood.png")
    (folder / "models" / "maps" / "wood.png").write_bytes(b"wood")
    (folder / "sky.hdr").write_bytes(b"sky")
    (tmp_path / "secret").write_bytes(SECRET)
    return folder


def refusal(folder: AssetFolder, path: str, named_by: Asset | None = None) -> str:
    """The message that refuses a file, after the place: one printable paragraph."""
    reader = AssetReader(folder)
    with pytest.raises(SceneError) as caught:
        reader.read(path, WHERE, named_by)
    message = str(caught.value)
    assert message.startswith(f"{WHERE}: ")
    assert message.isprintable()
    assert message.endswith((".", "?"))
    assert reader.assets == ()
    return message.removeprefix(f"{WHERE}: ")


# --- what is read ----------------------------------------------------------------------------


def test_a_file_is_read_with_its_hash_and_size(base: Path) -> None:
    asset = AssetReader(AssetFolder(base)).read("sky.hdr", WHERE)
    digest = hashlib.sha256(b"sky").hexdigest()
    assert (asset.path, asset.content, asset.sha256, asset.size) == ("sky.hdr", b"sky", digest, 3)


def test_files_are_named_relative_to_the_file_that_names_them(base: Path) -> None:
    reader = AssetReader(AssetFolder(base))
    model = reader.read("models/chair.obj", WHERE)
    material = reader.read("chair.mtl", WHERE, named_by=model)
    reader.read("maps/wood.png", WHERE, named_by=material)
    sky = reader.read("../sky.hdr", WHERE, named_by=model)
    assert sky is reader.read("./models/../sky.hdr", WHERE)
    paths = "models/chair.obj models/chair.mtl models/maps/wood.png sky.hdr"
    assert list(reader.hashes) == paths.split()
    assert reader.hashes["models/maps/wood.png"] == hashlib.sha256(b"wood").hexdigest()
    assert [asset.size for asset in reader.assets] == [16, 20, 4, 3]


def test_a_folder_that_was_moved_gives_the_same_hashes(base: Path, tmp_path: Path) -> None:
    names = ("sky.hdr", "models/chair.obj")
    before = AssetReader(AssetFolder(base))
    for name in names:
        before.read(name, WHERE)
    moved = shutil.move(base, tmp_path / "elsewhere")
    after = AssetReader(AssetFolder(Path(moved), expected=before.hashes))
    for name in names:
        after.read(name, WHERE)
    assert after.hashes == before.hashes


def test_a_file_is_read_once_though_it_is_replaced_meanwhile(base: Path) -> None:
    (base / "same.hdr").symlink_to("sky.hdr")
    reader = AssetReader(AssetFolder(base))
    first = reader.read("sky.hdr", WHERE)
    (base / "sky.hdr").write_bytes(b"night")
    assert reader.read("sky.hdr", WHERE) is first
    assert reader.read("same.hdr", WHERE).content == b"sky"
    assert len(set(reader.hashes.values())) == 1
    assert AssetReader(AssetFolder(base)).read("sky.hdr", WHERE).content == b"night"


def test_links_are_followed_inside_the_folder(base: Path, tmp_path: Path) -> None:
    (base / "link.png").symlink_to("models/maps/wood.png")
    (base / "maps").symlink_to(base / "models" / "maps")
    (tmp_path / "shortcut").symlink_to(base)
    for folder in (base, tmp_path / "shortcut"):
        reader = AssetReader(AssetFolder(folder))
        for path in ("link.png", "maps/wood.png"):
            assert reader.read(path, WHERE).content == b"wood"
        assert list(reader.hashes) == ["link.png", "maps/wood.png"]


# --- what leads out --------------------------------------------------------------------------


@pytest.mark.parametrize(
    "path",
    [
        *("../secret", "models/../../secret", "./../secret", "..", "../nothing.here"),
        *("/etc/passwd", "//host/share/secret", "C:/secret", "c:secret", "../Scene/sky.hdr"),
    ],
)
def test_a_path_that_leads_out_is_refused(base: Path, path: str) -> None:
    said = refusal(AssetFolder(base), path)
    assert "lies outside the folder" in said
    assert "--allow-outside if you trust the scene" in said
    assert "secret'?" not in said


def test_an_absolute_path_is_refused_though_it_lies_inside(base: Path) -> None:
    assert "lies outside" in refusal(AssetFolder(base), str(base / "sky.hdr"))


def test_a_folder_whose_name_begins_alike_lies_outside(base: Path, tmp_path: Path) -> None:
    (tmp_path / "scene-private").mkdir()
    (tmp_path / "scene-private" / "key").write_bytes(SECRET)
    (base / "link").symlink_to(tmp_path / "scene-private")
    assert "lies outside" in refusal(AssetFolder(base), "../scene-private/key")
    assert "a link that leads out" in refusal(AssetFolder(base), "link/key")


def test_a_link_that_leads_out_is_refused_and_reports_nothing(base: Path, tmp_path: Path) -> None:
    (base / "file").symlink_to(tmp_path / "secret")
    (base / "up").symlink_to("..")
    (base / "chain").symlink_to("up/secret")
    (base / "dangling").symlink_to("../secrets")
    for path in ("file", "up/secret", "up/secrets", "chain", "dangling"):
        said = refusal(AssetFolder(base), path)
        assert said.startswith(f"'{path}' is a link that leads out of the folder")
        assert "did you mean" not in said


def test_a_link_is_left_by_the_path_as_it_is_written(base: Path) -> None:
    """The rule is that of a URL: `..` takes a name away, wherever the link led."""
    (base / "maps").symlink_to("models/maps")
    assert AssetReader(AssetFolder(base)).read("maps/../sky.hdr", WHERE).path == "sky.hdr"


def test_a_file_that_names_another_opens_no_way_out(base: Path) -> None:
    model = AssetReader(AssetFolder(base)).read("models/chair.obj", WHERE)
    for path in ("../../secret", "/etc/passwd", "maps/../../../secret"):
        said = refusal(AssetFolder(base), path, named_by=model)
        assert said.startswith("models/chair.obj: '")
        assert "lies outside" in said


def test_the_user_can_allow_what_lies_outside(base: Path, tmp_path: Path) -> None:
    (base / "file").symlink_to(tmp_path / "secret")
    (tmp_path / "other").mkdir()
    (tmp_path / "other" / "room.mtl").write_bytes(b"mtl")
    reader = AssetReader(AssetFolder(base, allow_outside=True))
    for path in ("../secret", "file", str(tmp_path / "secret")):
        assert reader.read(path, WHERE).content == SECRET
    reader.read("room.mtl", WHERE, named_by=Asset("../other/room.obj", b"", "", tmp_path))
    absolute = (tmp_path / "secret").as_posix()
    assert list(reader.hashes) == ["../secret", "file", absolute, "../other/room.mtl"]


# --- what is no file -------------------------------------------------------------------------


def test_paths_that_are_none_are_refused(base: Path) -> None:
    folder = AssetFolder(base)
    assert refusal(folder, "") == "the path of a file is empty. Give the path of one."
    assert "holds a backslash. Write '/'" in refusal(folder, "models\\chair.obj")
    assert "holds a backslash" in refusal(folder, "\\\\host\\share\\secret")
    assert "no file can have the name 'sky.hdr\\x00../secret'" in refusal(
        folder, "sky.hdr\0../secret"
    )
    assert "no file can have the name" in refusal(folder, "\ud800.hdr")
    assert "cannot be read: File name too long" in refusal(folder, "x" * 5000)


def test_folders_are_refused(base: Path) -> None:
    for path in ("models", "models/", ".", "models/.."):
        assert "is a folder. Name a file in it." in refusal(AssetFolder(base), path)


def test_pipes_and_devices_are_refused_without_waiting(
    base: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    os.mkfifo(base / "pipe")
    assert "'pipe' is a pipe or a device" in refusal(AssetFolder(base), "pipe")
    outside = AssetFolder(base, allow_outside=True)
    assert "is a pipe or a device" in refusal(outside, "/dev/zero")
    monkeypatch.setattr(assets, "check_regular", lambda path: None)  # it became one since
    assert "is a pipe or a device" in refusal(AssetFolder(base), "pipe")


def test_a_link_that_takes_the_place_of_a_file_is_not_followed(
    base: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def swap(path: Path) -> None:
        path.unlink()
        path.symlink_to(tmp_path / "secret")

    monkeypatch.setattr(assets, "check_regular", swap)
    assert "'sky.hdr' cannot be read: Too many levels" in refusal(AssetFolder(base), "sky.hdr")


def test_a_circle_of_links_is_refused(base: Path) -> None:
    (base / "a").symlink_to("b")
    (base / "b").symlink_to("a")
    assert "'a' cannot be read: Too many levels" in refusal(AssetFolder(base), "a")


def test_a_missing_file_is_named_with_its_neighbour(base: Path) -> None:
    folder = AssetFolder(base)
    said = refusal(folder, "models/chiar.obj")
    assert said == f"there is no file 'models/chiar.obj' in {base}; did you mean 'chair.obj'?"
    assert refusal(folder, "nowhere/x.png").endswith("Check the path.")
    assert refusal(folder, "sky.hdr/x.png").startswith("there is no file 'sky.hdr/x.png'")
    listed = AssetFolder(base, expected={"qqq": ""})
    assert "that holds the files of the scene with --assets-from." in refusal(listed, "qqq")


def test_a_file_that_cannot_be_read_says_why(base: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(path: Path) -> None:
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(assets, "check_regular", refuse)
    said = refusal(AssetFolder(base), "sky.hdr")
    assert said.startswith("'sky.hdr' cannot be read: Permission denied. Check")


# --- sizes -----------------------------------------------------------------------------------


def test_a_file_that_is_too_large_is_refused_unread(base: Path) -> None:
    with (base / "sparse.bin").open("wb") as file:
        file.truncate(1 << 40)
    said = refusal(AssetFolder(base), "sparse.bin")
    assert said == "'sparse.bin' is larger than 1,024 MiB. Use a smaller file."
    assert AssetReader(AssetFolder(base, largest=3)).read("sky.hdr", WHERE).size == 3
    assert "larger than 2 bytes" in refusal(AssetFolder(base, largest=2), "sky.hdr")


def test_all_files_together_are_limited_and_a_file_counts_once(base: Path) -> None:
    (base / "same.hdr").symlink_to("sky.hdr")
    reader = AssetReader(AssetFolder(base, largest_in_all=7))
    for path in ("sky.hdr", "same.hdr", "sky.hdr", "models/maps/wood.png"):
        reader.read(path, WHERE)
    with pytest.raises(SceneError, match=r"with 'models/chair\.obj' .* more than 7 bytes"):
        reader.read("models/chair.obj", WHERE)


@pytest.mark.skipif(not Path("/proc/self/status").exists(), reason="no files that grow as read")
def test_a_file_that_grows_while_it_is_read_is_refused(base: Path) -> None:
    said = refusal(AssetFolder(base, allow_outside=True), "/proc/self/status")
    assert "cannot be read: it changed while it was read" in said


# --- recipes ---------------------------------------------------------------------------------


def test_other_content_than_a_recipe_was_made_with_is_refused_by_name(base: Path) -> None:
    old = hashlib.sha256(b"dusk").hexdigest()
    new = hashlib.sha256(b"sky").hexdigest()
    said = refusal(AssetFolder(base, expected={"sky.hdr": old}), "sky.hdr")
    assert said.startswith("'sky.hdr' is not the file that this picture was made with: its SHA-256")
    assert f"begins with {new[:12]}, not {old[:12]}" in said
    assert said.endswith("accept the new one with --assets changed.")
    accepted = AssetFolder(base, expected={"sky.hdr": old}, accept_changed=True)
    reader = AssetReader(accepted)
    reader.read("sky.hdr", WHERE)
    assert reader.hashes == {"sky.hdr": new}


def test_a_picture_reads_no_file_that_its_recipe_does_not_list(base: Path) -> None:
    for accept in (False, True):
        folder = AssetFolder(base, expected={"sky.hdr": ""}, accept_changed=accept)
        said = refusal(folder, "models/chair.obj")
        assert said.startswith("the recipe of this picture does not list 'models/chair.obj'")
        assert "does not list" in refusal(folder, "nothing.obj")


def test_a_recipe_that_lists_a_file_outside_opens_no_way_there(base: Path) -> None:
    digest = hashlib.sha256(SECRET).hexdigest()
    folder = AssetFolder(base, expected={"../secret": digest})
    assert "lies outside" in refusal(folder, "../secret")
    allowed = AssetFolder(base, allow_outside=True, expected={"../secret": digest})
    assert AssetReader(allowed).read("../secret", WHERE).content == SECRET


def test_a_second_path_to_a_file_is_held_to_its_own_hash(base: Path) -> None:
    (base / "same.hdr").symlink_to("sky.hdr")
    digest = hashlib.sha256(b"sky").hexdigest()
    reader = AssetReader(AssetFolder(base, expected={"sky.hdr": digest, "same.hdr": "0" * 64}))
    reader.read("sky.hdr", WHERE)
    with pytest.raises(SceneError, match=r"'same\.hdr' is not the file"):
        reader.read("same.hdr", WHERE)
