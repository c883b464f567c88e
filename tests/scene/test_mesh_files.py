"""Files of meshes: what is read of each format, what is refused, and scenes that name them."""

import random
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

import glrt
from glrt.cli.main import main
from glrt.core.errors import SceneError
from glrt.scene.files.named_meshes import mesh_of_arrays
from glrt.scene.loading.scene_files import files_of
from glrt.scene.model_files.mesh_formats import decode_mesh
from tests.support.meshes import box, icosphere

SCENE = """
[camera]
position = [0.5, 1, 4]
look_at = [0, 0, 0]

[background]
color = [0.5, 0.6, 0.7]

[materials.clay]
type = "lambertian"
color = [0.7, 0.5, 0.3]

[[objects]]
shape = "mesh"
file = "models/thing.ply"
material = "clay"
translate = [0.1, 0.2, 0.3]
rotate = [10, 20, 30]
scale = 1.5
"""
POINTS, FACES = box([-1, -1, -1], [1, 1, 1])
SQUARES = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
SMALL = ["--width", "16", "--height", "8", "--samples", "2", "--quiet"]


def ascii_ply(faces: Any, extra: str = "") -> bytes:
    head = ["ply", "format ascii 1.0", f"element vertex {len(POINTS)}"]
    head += [f"property float {axis}" for axis in "xyz"]
    head += [f"element face {len(faces)}", "property list uchar int vertex_indices", "end_header"]
    rows = [" ".join(map(str, point)) for point in POINTS]
    rows += [" ".join(map(str, [len(face), *face])) for face in faces]
    return ("\n".join([*head, *rows]) + "\n" + extra).encode()


def obj(faces: Any, vertex: str = "{}", extra: str = "") -> bytes:
    lines = ["# a comment", "mtllib nowhere.mtl", "o thing"]
    lines += [f"v {x} {y} {z}" for x, y, z in POINTS] + [extra, "usemtl red"]
    lines += ["f " + " ".join(vertex.format(k) for k in face) for face in faces]
    return ("\n".join(lines) + "\n").encode()


def ascii_stl() -> bytes:
    lines = ["solid thing"]
    for face in FACES:
        lines += ["facet normal 0 0 0", "outer loop"]
        lines += [f"vertex {x} {y} {z}" for x, y, z in POINTS[face]]
        lines += ["endloop", "endfacet"]
    return ("\n".join([*lines, "endsolid thing"]) + "\n").encode()


def binary_stl() -> bytes:
    rows = np.zeros(len(FACES), [("normal", "<f4", 3), ("corner", "<f4", (3, 3)), ("more", "<u2")])
    rows["corner"] = POINTS[FACES]
    return b"a binary file".ljust(80) + np.uint32(len(FACES)).tobytes() + rows.tobytes()


FILES: dict[str, tuple[str, bytes]] = {
    "binary PLY": (".ply", mesh_of_arrays(POINTS, FACES).content or b""),
    "PLY with normals": (".ply", mesh_of_arrays(POINTS, FACES, POINTS).content or b""),
    "PLY in text": (".ply", ascii_ply(FACES)),
    "PLY of squares": (".ply", ascii_ply(SQUARES)),
    "OBJ": (".obj", obj(FACES + 1)),
    "OBJ of squares": (".OBJ", obj(np.array(SQUARES) + 1)),
    "OBJ of squares and triangles": (
        ".obj",
        obj([*(FACES[[0, 6]] + 1).tolist(), *(np.array(SQUARES[1:]) + 1).tolist()]),
    ),
    "OBJ from the end": (".obj", obj(np.array(SQUARES) - 8)),
    "OBJ with texture": (".obj", obj(FACES + 1, "{}/1", "vt 0 0")),
    "OBJ with normals": (".obj", obj(FACES + 1, "{0}//{0}", "vn 1 1 1\n" * 8)),
    "STL in text": (".stl", ascii_stl()),
    "STL": (".stl", binary_stl()),
}


@pytest.mark.parametrize("name", FILES)
def test_a_box_is_read_from_every_format(name: str) -> None:
    suffix, content = FILES[name]
    mesh = decode_mesh(content, f"thing{suffix}", "scene.toml: objects[0].file")
    assert mesh.opening == ""
    corner = mesh.vertices[mesh.faces]
    area = np.linalg.norm(
        np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]), axis=1
    )
    assert area.sum() / 2 == pytest.approx(24)
    middle = corner.mean(axis=1)
    across = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    assert ((middle * across).sum(axis=1) > 0).all(), "outwards"
    assert (mesh.normals is not None) == ("normals" in name)


def test_arrays_are_kept_to_the_last_digit() -> None:
    points, faces = icosphere(2)
    named = mesh_of_arrays(points / 3, faces, points)
    assert named.content
    mesh = decode_mesh(named.content, named.file, "here")
    assert np.array_equal(mesh.vertices, points / 3)
    assert np.array_equal(mesh.faces, faces)
    assert mesh.normals is not None
    assert_allclose(mesh.normals, points, atol=1e-15)


BROKEN: dict[str, tuple[str, bytes, str]] = {
    "of another format": ("thing.fbx", b"", "'thing.fbx' is no file of a mesh that glrt reads"),
    "empty PLY": ("thing.ply", b"", "is damaged, or no PLY file"),
    "empty OBJ": ("thing.obj", b"", "is damaged, or no OBJ file"),
    "empty STL": ("thing.stl", b"", "is damaged, or no STL file"),
    "points alone": ("thing.ply", ascii_ply([]), "it has no triangles"),
    "half a PLY": ("thing.ply", FILES["binary PLY"][1][:-30], "is damaged, or no PLY file"),
    "half an STL": ("thing.stl", binary_stl()[:-60], "is damaged, or no STL file"),
    "a corner that is not there": ("thing.ply", ascii_ply([[0, 1, 99]]), "names vertex 99"),
    "an OBJ corner that is not there": ("thing.obj", obj([[1, 2, 99]]), "no OBJ file"),
    "a huge PLY": (
        "thing.ply",
        FILES["binary PLY"][1].replace(b"vertex 8", b"vertex 80000000000000"),
        "no PLY file",
    ),
    "no number": (
        "thing.ply",
        ascii_ply(FACES).replace(b"1.0 1.0 1.0", b"nan 1.0 1.0"),
        "vertex 3",
    ),
}


@pytest.mark.parametrize("name", BROKEN)
def test_what_is_no_mesh_is_refused_with_its_name(name: str) -> None:
    path, content, message = BROKEN[name]
    with pytest.raises(SceneError) as caught:
        decode_mesh(content, path, "scene.toml: objects[0].file")
    told = str(caught.value)
    assert told.startswith("scene.toml: objects[0].file: 'thing.")
    assert message in told
    assert "\n" not in told


def damaged(content: bytes, seed: int) -> bytes:
    """Some bytes changed, cut, or doubled."""
    draw = random.Random(seed)
    data = bytearray(content)
    for _ in range(draw.randint(1, 8)):
        if not data:
            break
        start = draw.randrange(len(data))
        end = min(len(data), start + draw.randint(1, 40))
        choice = draw.randrange(4)
        if choice == 0:
            data[start] = draw.randrange(256)
        elif choice == 1:
            del data[start:end]
        elif choice == 2:
            data[start:start] = data[start:end]
        else:
            data[start:end] = draw.choice(
                [b"-1 ", b"1e999 ", b"nan ", b"\0", b"99999999999 ", b"\n"]
            )
    return bytes(data)


# Messages of Python and its libraries say nothing about a file.
FOREIGN = (
    *("could not convert", "need at least one", "too large to convert", "No module", "codec"),
    *("index out of", "out of bounds", "cannot reshape", "broadcast", "itemsize", "object has no"),
)


def survives(name: str, seed: int) -> None:
    suffix, content = FILES[name]
    start = time.process_time()
    told = ""
    try:
        decode_mesh(damaged(content, seed), f"thing{suffix}", "here")
    except SceneError as error:
        told = str(error)
    assert not told or told.startswith("here: 'thing")
    assert not any(words in told for words in FOREIGN)
    assert time.process_time() - start < 10


@pytest.mark.parametrize("name", FILES)
def test_damaged_files_are_read_or_refused(name: str) -> None:
    for seed in range(20):
        survives(name, seed)


@pytest.mark.slow
@pytest.mark.parametrize("name", FILES)
def test_hundreds_of_damaged_files_are_read_or_refused(name: str) -> None:
    for seed in range(1000, 1300):
        survives(name, seed)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A scene and its mesh."""
    (tmp_path / "models").mkdir()
    (tmp_path / "models/thing.ply").write_bytes(FILES["binary PLY"][1])
    (tmp_path / "scene.toml").write_text(SCENE)
    return tmp_path


def test_a_scene_with_a_mesh_is_saved_and_read_again(folder: Path, tmp_path: Path) -> None:
    scene = glrt.load(folder / "scene.toml")
    assert files_of(scene) == ["models/thing.ply"]
    (tmp_path / "other").mkdir()
    scene.save(tmp_path / "other" / "room.toml")
    again = glrt.load(tmp_path / "other" / "room.toml")
    assert again == scene
    assert (tmp_path / "other/models/thing.ply").read_bytes() == FILES["binary PLY"][1]


def test_a_mesh_of_arrays_is_saved_next_to_its_scene(tmp_path: Path) -> None:
    scene = glrt.Scene.build(
        {"position": [0, 0, 4], "look_at": [0, 0, 0]},
        [glrt.Mesh(POINTS, FACES, material="clay"), glrt.Mesh(POINTS, FACES, material="clay")],
        materials={"clay": glrt.Lambertian(color=(0.5, 0.5, 0.5))},
        background={"color": (1, 1, 1)},
    )
    scene.save(tmp_path / "scene.toml")
    assert glrt.load(tmp_path / "scene.toml") == scene
    assert len(list(tmp_path.glob("mesh-*.ply"))) == 1
    image = glrt.render(scene, samples=2, width=16, height=8)
    image.save(tmp_path / "a.exr")
    assert main(["render", str(tmp_path / "a.exr"), "-o", str(tmp_path / "b.npy"), "--quiet"]) == 0
    assert np.array_equal(np.load(tmp_path / "b.npy"), image.radiance)


def test_the_command_reports_of_the_mesh(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["inspect", str(folder / "scene.toml")]) == 0
    told = capsys.readouterr().out
    assert "1 mesh of 12 triangles" in told
    assert "over 12 triangles" in told
    words = ["render", str(folder / "scene.toml"), "-o", str(folder / "a.exr"), "--json", *SMALL]
    assert main(words) == 0
    told = capsys.readouterr().out
    assert '"triangles": 12' in told
    assert '"assets": {"models/thing.ply": "' in told


@pytest.mark.slow_cases("change7-")
@pytest.mark.parametrize(
    ("change", "message"),
    [
        (('"models/thing.ply"', '"models/thin.ply"'), "did you mean 'thing.ply'?"),
        (('"models/thing.ply"', '"../thing.ply"'), "lies outside the folder"),
        (('"models/thing.ply"', "3"), "objects[0].file must be the path of a file"),
        (("scale = 1.5", "scale = 0.0"), "objects[0].scale must be numbers of at least"),
        (("scale = 1.5", "scale = [1, 2]"), "objects[0].scale"),
        (("scale = 1.5", "matrix = [[1, 0], [0, 1]]"), "objects[0].matrix"),
        (("scale = 1.5", "size = 1.5"), "unknown key 'size'. Keys of a mesh"),
        (('type = "lambertian"\ncolor = [0.7, 0.5, 0.3]', 'type = "dielectric"'), ""),
    ],
)
def test_a_wrong_key_is_one_paragraph(
    folder: Path,
    capsys: pytest.CaptureFixture[str],
    change: tuple[str, str],
    message: str,
) -> None:
    (folder / "scene.toml").write_text(SCENE.replace(*change))
    code = main(["render", str(folder / "scene.toml"), "-o", str(folder / "a.npy"), *SMALL])
    assert code == (2 if message else 0)
    told = capsys.readouterr().err
    assert message in told
    assert told.count("\n") <= 1


def test_open_glass_is_refused_before_anything_compiles(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (folder / "models/thing.ply").write_bytes(ascii_ply(FACES[1:]))
    text = SCENE.replace('type = "lambertian"\ncolor = [0.7, 0.5, 0.3]', 'type = "dielectric"')
    (folder / "scene.toml").write_text(text)
    assert main(["render", str(folder / "scene.toml"), "-o", str(folder / "a.npy"), *SMALL]) == 2
    told = capsys.readouterr().err
    assert "objects[0].file: models/thing.ply: 3 edges belong to one triangle" in told
