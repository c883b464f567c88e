"""Cameras of glTF files in scene files: `[camera] file`."""

import tomllib
from pathlib import Path
from typing import Any

import pytest
from numpy.testing import assert_allclose

import glrt
from glrt.core.errors import SceneError
from glrt.image.sources import FileRules, load, load_recipe
from glrt.scene.camera import Camera
from glrt.scene.files.assets import AssetFolder
from glrt.scene.loading.scene_files import hashes_of, with_files, with_hashes
from glrt.scene.scene import Scene
from glrt.scene.scenefile.toml import parse_scene, scene_to_dict
from glrt.scene.scenefile.toml_writer import write_scene
from glrt.settings import RenderSettings
from tests.support.gltf_files import Builder, square

SKY = "\n[background]\ncolor = [1, 1, 1]\n"
FOV = 45.836623610465864  # of 0.8 rad


def camera(aspect: float | None = 2.0, **more: Any) -> dict[str, Any]:
    lens = {"yfov": 0.8} | ({} if aspect is None else {"aspectRatio": aspect})
    return {"type": "perspective", "perspective": lens, **more}


def cameras() -> Builder:
    """A file with cameras: `still`, `crane` on a `rig` that moves by 2, one flat, and two twins."""
    builder = Builder()
    builder.shown(square(builder))
    round_, flat = (
        builder.add("cameras", camera()),
        builder.add("cameras", {"type": "orthographic"}),
    )
    builder.add("nodes", {"name": "still", "camera": round_, "translation": [1, 2, 3]})
    builder.add("nodes", {"name": "rig", "translation": [9, 9, 9], "children": [3]})
    builder.add("nodes", {"name": "crane", "camera": round_, "translation": [0, 0, 3]})
    builder.add("nodes", {"name": "flat", "camera": flat})
    for _ in "ab":
        builder.add("nodes", {"name": "twin", "camera": round_})
    idle = {"input": builder.accessor([0.0, 5]), "output": builder.accessor([[1, 1, 1]] * 2)}
    moves = {
        "input": builder.accessor([0.0, 2]),
        "output": builder.accessor([[0, 0, 0], [2, 0, 0]]),
    }
    for name, node, path, sampler in (
        ("idle", 0, "scale", idle),
        ("ride", 2, "translation", moves),
    ):
        channel = {"sampler": 0, "target": {"node": node, "path": path}}
        builder.add("animations", {"name": name, "samplers": [sampler], "channels": [channel]})
    return builder


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "cams.glb").write_bytes(cameras().glb())
    return tmp_path


def scene_of(folder: Path, *lines: str, more: str = "", file: str = "cams.glb") -> Scene:
    path = folder / "scene.toml"
    path.write_text("\n".join(["[camera]", f'file = "{file}"', *lines]) + SKY + more)
    return load(path)


def test_a_camera_is_that_of_a_node(folder: Path) -> None:
    found = scene_of(folder, 'node = "still"').camera
    assert (found.position, found.look_at, found.up) == ((1, 2, 3), (1, 2, 2), (0, 1, 0))
    assert found.fov == pytest.approx(FOV)
    assert scene_of(folder, 'node = "6"').camera.position == (0, 0, 0), "a twin, by its number"


def test_keys_that_are_given_count_instead(folder: Path) -> None:
    found = scene_of(folder, 'node = "still"', "position = [1, 2, 9]", "fov = 30.0").camera
    assert (found.position, found.look_at, found.fov) == ((1, 2, 9), (1, 2, 2), 30)
    turned = Camera.model_validate({**dict(found), "fov": 31.0})
    assert turned.model_fields_set >= {"position", "fov"}
    assert "look_at" not in turned.model_fields_set, "the file still gives it"


@pytest.mark.parametrize(
    ("lines", "told"),
    [
        ([], "it has 4 cameras: choose one by `node`"),
        (['node = "stil"'], "it shows no node 'stil'; did you mean 'still'"),
        (['node = "rig"'], "node 'rig' has no camera"),
        (['node = "flat"'], "the camera of node 'flat' has no perspective"),
        (['node = "twin"'], r"2 nodes with a camera are named 'twin'.* node = '5' or '6'"),
    ],
)
def test_a_node_without_one_camera_is_refused_with_those_that_have_one(
    folder: Path, lines: list[str], told: str
) -> None:
    whole = rf"scene\.toml: camera: cams\.glb: {told}.*: 'still', 'crane', '5', '6'\.$"
    with pytest.raises(SceneError, match=whole):
        scene_of(folder, *lines)


@pytest.mark.parametrize(
    ("file", "lines", "told"),
    [
        ("cams.obj", [], r"camera\.file: 'cams\.obj' is no glTF or USD file"),
        ("none.glb", [], r"camera\.file: there is no file 'none\.glb'"),
        ("cams.glb", ['node = "still"', 'animation = "x"'], "unknown animation 'x'.* idle, ride"),
        ("cams.glb", ['node = "still"', "up = [0, 0, 1]"], "up is parallel to the view"),
        ("bad.glb", [], r"camera\.file: 'bad\.glb': its JSON is wrong"),
        ("plain.glb", [], "it has no camera that glrt can see by. No node that it shows has"),
        ("plain.glb", ['node = "x"', "time = 1.0"], "it shows no node 'x'"),
    ],
)
def test_what_gives_no_camera_is_refused(
    folder: Path, file: str, lines: list[str], told: str
) -> None:
    (folder / "bad.glb").write_bytes(b"{,")
    builder = Builder()
    builder.shown(square(builder), name="x y")
    (folder / "plain.glb").write_bytes(builder.glb())
    with pytest.raises(SceneError, match=told):
        scene_of(folder, *lines, file=file)


def test_a_node_without_a_file_is_refused() -> None:
    eye = {"position": [0, 0, 1], "look_at": [0, 0, 0], "node": "x"}
    with pytest.raises(SceneError, match="node belongs to a `file` with a camera"):
        parse_scene({"camera": eye, "background": {"color": [1, 1, 1]}}, "x")


def test_a_camera_without_place_or_file_is_refused_as_before() -> None:
    with pytest.raises(SceneError, match=r"camera\.position is missing"):
        parse_scene({"camera": {"look_at": [0, 0, 0]}, "background": {"color": [1, 1, 1]}}, "x")


def test_a_file_outside_of_the_folder_needs_leave(folder: Path) -> None:
    below = folder / "below"
    below.mkdir()
    with pytest.raises(SceneError, match=r"camera\.file: .*--allow-outside"):
        scene_of(below, 'node = "still"', file="../cams.glb")
    scene, _ = load_recipe(below / "scene.toml", FileRules(allow_outside=True))
    assert scene.camera.position == (1, 2, 3)


@pytest.mark.parametrize(
    ("more", "size"),
    [
        ("", (512, 256)),
        ("[render]\nsamples = 2", (512, 256)),
        ("[render]\nwidth = 512", (512, 512)),
        ("[render]\nheight = 99", (512, 99)),
    ],
)
def test_a_picture_without_a_size_has_the_shape_of_the_camera(
    folder: Path, more: str, size: tuple[int, int]
) -> None:
    scene = scene_of(folder, 'node = "still"', more=more)
    assert (scene.render.width, scene.render.height) == size
    scene.save(folder / "again.toml")
    assert load(folder / "again.toml").render == scene.render


def test_a_camera_moves_where_the_first_animation_that_moves_it_moves_it(folder: Path) -> None:
    scene = scene_of(folder, 'node = "crane"')
    assert scene.frames == 49
    places = [scene.at_frame(number).camera.position for number in (0, 24, 48)]
    assert_allclose(places, [(0, 0, 3), (1, 0, 3), (2, 0, 3)], atol=1e-6)
    assert scene.at_frame(24).camera.look_at[0] == pytest.approx(1)
    assert scene_of(folder, 'node = "still"').animation is None


def test_keys_that_are_given_hold_while_the_camera_moves(folder: Path) -> None:
    scene = scene_of(folder, 'node = "crane"', "look_at = [0, 0, 0]", "fov = 20.0")
    last = scene.at_frame(48).camera
    assert (last.position, last.look_at, last.fov) == ((2, 0, 3), (0, 0, 0), 20)


def test_a_camera_with_a_time_stands_there(folder: Path) -> None:
    scene = scene_of(folder, 'node = "crane"', "time = 1.5")
    assert scene.frames == 1
    assert scene.camera.position == (1.5, 0, 3)


def test_other_tracks_and_frames_stay(folder: Path) -> None:
    more = (
        '[animation]\nframes = 3\nfps = 1.0\n[[animation.tracks]]\ntarget = "lights.background"\n'
    )
    scene = scene_of(folder, 'node = "crane"', more=more + "times = [0, 2]\nvalues = [1, 3]")
    assert scene.frames == 3
    last = scene.at_frame(2)
    assert last.camera.position == (2, 0, 3)
    assert last.lights == {"background": 3}


def test_a_track_of_its_own_replaces_the_motion_of_the_file(folder: Path) -> None:
    track = '[[animation.tracks]]\ntarget = "camera.time"\ntimes = [0, 1]\nvalues = [2, 0]'
    scene = scene_of(folder, 'node = "crane"', more=track)
    assert [scene.at_frame(n).camera.position[0] for n in (0, 24)] == [2, 0]
    with pytest.raises(SceneError, match=r"time belongs to a `file`"):
        parse_scene(
            {
                **tomllib.loads(track),
                "camera": {"position": [0, 0, 1], "look_at": [0] * 3},
                "background": {"color": [1, 1, 1]},
            },
            "x",
        )


def test_a_saved_scene_keeps_file_node_and_motion(folder: Path) -> None:
    scene = scene_of(folder, 'node = "crane"', "defocus_angle = 2.0")
    scene.save(folder / "again.toml")
    text = (folder / "again.toml").read_text()
    assert 'file = "cams.glb"' in text
    assert "position" not in text
    again = load(folder / "again.toml")
    assert again == scene
    assert again.at_frame(48).camera.position == (2, 0, 3)


def test_a_save_keeps_comments_and_copies_the_file(folder: Path) -> None:
    scene = scene_of(folder, 'node = "crane"  # the tall one')
    new = folder / "new"
    new.mkdir()
    assert write_scene(scene, new / "scene.toml", folder / "scene.toml")
    assert "# the tall one" in (new / "scene.toml").read_text()
    assert load(new / "scene.toml") == scene


def test_a_save_with_comments_keeps_the_size_of_the_picture(folder: Path) -> None:
    scene = scene_of(folder, 'node = "still"')
    wide = scene.model_copy(update={"render": RenderSettings(width=512, height=512)})
    assert write_scene(wide, folder / "scene.toml", folder / "scene.toml")
    assert load(folder / "scene.toml").render.height == 512


def test_a_recipe_reads_the_camera_again_and_lists_its_file(folder: Path) -> None:
    still = scene_of(folder, 'node = "crane"').at_frame(24)
    hashes, told = hashes_of(still), scene_to_dict(still)
    assert list(hashes) == ["cams.glb"]
    assert told["camera"]["time"] == 1
    unread = with_hashes(parse_scene(told, "recipe"), hashes)
    assert unread == still
    again = with_files(unread, AssetFolder(folder, expected=hashes), "recipe")
    assert again.camera.position == still.camera.position
    assert again.animation is None, "a picture is a still"
    (folder / "cams.glb").write_bytes(cameras().glb() + b"\0")
    with pytest.raises(SceneError, match="is not the file that this picture was made with"):
        with_files(unread, AssetFolder(folder, expected=hashes), "recipe")


def test_python_code_takes_a_camera_of_a_file(folder: Path) -> None:
    eye = glrt.Camera(file="cams.glb", node="still", focus_distance=3)
    scene = Scene.build(eye, background={"color": (1, 1, 1)}, folder=folder)
    assert scene.camera.position == (1, 2, 3)
    assert scene.camera.focus_distance == 3


def test_a_model_alone_keeps_the_motion_of_its_camera(folder: Path) -> None:
    builder = cameras()
    del builder.json["nodes"][1]["camera"]
    (folder / "cams.glb").write_bytes(builder.glb())
    scene = load(folder / "cams.glb")
    assert scene.camera.position == (9, 9, 12), "the pose without animation"
    assert (scene.render.width, scene.render.height) == (512, 256)
    assert scene.at_frame(48).camera.position == (2, 0, 3)
    scene.save(folder / "again.toml")
    assert load(folder / "again.toml").at_frame(48).camera.position == (2, 0, 3)


def test_a_model_alone_whose_camera_stands_has_its_numbers(folder: Path) -> None:
    scene = load(folder / "cams.glb")
    assert scene.camera.file is None
    assert scene.camera.position == (1, 2, 3)


def test_a_damaged_camera_behind_the_first_harms_no_model(folder: Path) -> None:
    builder = cameras()
    builder.json["nodes"][3]["camera"] = builder.add("cameras", camera(aspect=0.0))
    (folder / "cams.glb").write_bytes(builder.glb())
    assert load(folder / "cams.glb").camera.position == (1, 2, 3)
    with pytest.raises(SceneError, match="aspectRatio must be a number"):
        scene_of(folder, 'node = "crane"')
