"""Meshes with the materials of their OBJ files: divided, refused, saved, and rendered."""

from pathlib import Path

import numpy as np
import pytest

import glrt
from glrt.cli.main import main
from glrt.core.errors import SceneError
from glrt.image.image import Image, read_recipe
from glrt.plan.facts import SceneFacts
from glrt.scene.files.assets import AssetFolder
from glrt.scene.loading.scene_files import with_files
from glrt.scene.model_files.mesh_formats import decode_mesh
from glrt.scene.model_files.obj import libraries
from glrt.scene.scene import Scene
from glrt.scene.scenefile.toml_writer import write_scene
from glrt.scene.shapes.mesh import Mesh
from tests.support.meshes import box, icosphere

HEAD = """
[camera]
position = [0.5, 3, 6]
look_at = [0, 0, 0]
[background]
color = [0.1, 0.2, 0.3]
"""
OBJECT = """
# the thing
[[objects]]
shape = "mesh"
file = "models/two.obj"
translate = [0, 0.25, 0]
scale = [1, 1, -0.5]
group = "works"
"""
BALL = '[[objects]]\nshape = "sphere"\ncenter = [0, 3, 0]\nradius = 0.5\nmaterial = "matte"\n'
MATTE = '[materials.matte]\ntype = "lambertian"\ncolor = [0.5, 0.5, 0.5]\n'
MTL = "newmtl red\nKd 0.8 0.1 0.1\nnewmtl a lamp\nKe 4 4 3\nmap_Kd wood.png\n"
LEFT, RIGHT = box([-1, -1, -1], [1, 1, 1]), box([1.5, -1, -1], [2, 1, 1])
SMALL = ["--width", "32", "--height", "24", "--samples", "16", "--quiet"]


def obj(*names: str, library: str = "two.mtl", cut: int = 0) -> str:
    """Two boxes, each of a material; the second one lacks its last `cut` triangles."""
    lines, first = [f"mtllib {library}", "# usemtl nothing"], 1
    for name, (points, faces) in zip(names, (LEFT, RIGHT), strict=True):
        lines += [f"v {x} {y} {z}" for x, y, z in points]
        lines += [f"usemtl {name}"] if name else []
        kept = faces[: len(faces) - cut] if first > 1 else faces
        lines += ["f " + " ".join(map(str, face + first)) for face in kept]
        first += len(points)
    return "\n".join(lines) + "\n"


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "room/models").mkdir(parents=True)
    (tmp_path / "room/models/two.obj").write_text(obj("red", "a lamp"))
    (tmp_path / "room/models/two.mtl").write_text(MTL)
    (tmp_path / "room/scene.toml").write_text(HEAD + MATTE + OBJECT + BALL)
    return tmp_path / "room"


def render(source: Path, output: Path, *words: str) -> int:
    return main(["render", str(source), "-o", str(output), *SMALL, *words])


def meshes(scene: Scene) -> list[Mesh]:
    return [thing for thing in scene.objects if isinstance(thing, Mesh)]


def test_an_object_becomes_a_mesh_for_each_material(folder: Path) -> None:
    scene = glrt.load(folder / "scene.toml")
    assert [thing.material for thing in scene.objects] == [
        "models/two.obj:red",
        "matte",
        "models/two.obj:a lamp",
    ]
    assert scene.materials["models/two.obj:red"] == glrt.Lambertian(color=(0.8, 0.1, 0.1))
    assert [mesh.part for mesh in meshes(scene)] == ["red", "a lamp"]
    for mesh, (points, _) in zip(meshes(scene), (LEFT, RIGHT), strict=True):
        assert np.array_equal(np.sort(mesh.triangles.vertices, axis=0), np.sort(points, axis=0))
        assert (mesh.group, mesh.scale, mesh.triangles.opening) == ("works", (1, 1, -0.5), "")
    assert scene.light_groups == {"works": 1, "background": 1}
    assert SceneFacts(scene).triangles == 24


def test_python_may_leave_the_material_out(folder: Path) -> None:
    view = {"position": [0, 0, 4], "look_at": [0, 0, 0]}
    own = {"models/two.obj:red": glrt.Metal(preset="gold")}
    scene = glrt.Scene.build(view, [glrt.Mesh(file="models/two.obj")], materials=own, folder=folder)
    assert scene.materials["models/two.obj:red"] == own["models/two.obj:red"], "the scene's stands"
    part = glrt.Mesh(file="models/two.obj", part="a lamp")
    scene = glrt.Scene.build(view, [part], folder=folder)
    assert list(scene.materials) == ["models/two.obj:a lamp"]
    with pytest.raises(SceneError, match="has no materials of its own"):
        glrt.Scene.build(view, [glrt.Mesh(*LEFT)])


def test_the_picture_is_that_of_two_meshes_to_the_bit(folder: Path) -> None:
    """The lamp is sampled: the same bits come of scene materials and files of their own."""
    objects = ""
    for name, (points, faces), material in (
        ("left", LEFT, 'type = "lambertian"\ncolor = [0.8, 0.1, 0.1]'),
        ("right", RIGHT, 'type = "lambertian"\ncolor = [0, 0, 0]\nemission = [4, 4, 3]'),
    ):
        lines = [f"v {x} {y} {z}" for x, y, z in points]
        lines += ["f " + " ".join(map(str, face + 1)) for face in faces]
        (folder / f"{name}.obj").write_text("\n".join(lines))
        given = OBJECT.replace("models/two", name) + f'material = "{name}"\n'
        objects += f"[materials.{name}]\n{material}\n{BALL if objects else ''}{given}"
    (folder / "apart.toml").write_text(HEAD + MATTE + objects)
    first, second = (glrt.load(folder / f"{name}.toml") for name in ("scene", "apart"))
    assert SceneFacts(first).lamps == SceneFacts(second).lamps
    for name in ("scene", "apart"):
        assert render(folder / f"{name}.toml", folder / f"{name}.npy") == 0
    picture = np.load(folder / "scene.npy")
    assert np.array_equal(picture, np.load(folder / "apart.npy"))
    assert picture.max() >= 3


def test_normals_at_borders_are_those_of_the_whole() -> None:
    points, faces = icosphere(2)
    lines = [f"v {x} {y} {z}" for x, y, z in points]
    for name, rows in (("a", faces[:100]), ("b", faces[100:200]), ("a", faces[200:])):
        lines += [f"usemtl {name}"] + ["f " + " ".join(map(str, row + 1)) for row in rows]
    mesh = decode_mesh("\n".join(lines).encode(), "ball.obj", "here")
    normals = dict(zip(map(tuple, mesh.vertices), mesh.shading_normals, strict=True))
    assert [len(part.faces) for part in mesh.parts.values()] == [len(faces) - 100, 100]
    for part in mesh.parts.values():
        wanted = np.array([normals[tuple(place)] for place in part.vertices])
        assert np.array_equal(part.shading_normals, wanted)


def test_a_scene_is_saved_and_a_picture_rendered_again_without_the_mtl_file(
    folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    scene = glrt.load(folder / "scene.toml")
    assert render(folder / "scene.toml", folder / "a.exr", "--json") == 0
    assert '"models/two.mtl": "' in capsys.readouterr().out
    assert list(read_recipe(folder / "a.exr").assets) == ["models/two.obj"]
    assert write_scene(scene, folder / "copy.toml", folder / "scene.toml")
    assert glrt.load(folder / "copy.toml") == scene
    scene.save(tmp_path / "saved.toml")
    (folder / "models/two.mtl").unlink()
    assert glrt.load(tmp_path / "saved.toml") == scene
    assert render(folder / "a.exr", folder / "b.exr") == 0
    assert np.array_equal(
        Image.load(folder / "a.exr").radiance, Image.load(folder / "b.exr").radiance
    )


def test_what_is_not_read_is_reported_once(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["inspect", str(folder / "scene.toml")]) == 0
    told = capsys.readouterr().out
    assert told.count("models/two.mtl: left out of models/two.obj: map_Kd.") == 1
    assert "lambertian matte, models/two.obj:red, models/two.obj:a lamp" in told


WRONG: dict[str, tuple[str, str, str, str]] = {
    "no such file": (obj("red", "red", library="tow.mtl"), MTL, OBJECT, "did you mean 'two.mtl'?"),
    "outside": (obj("red", "red", library="../../x.mtl"), MTL, OBJECT, "lies outside the folder"),
    "no such name": (obj("red", "rod"), MTL, OBJECT, "unknown material 'rod'"),
    "no mtllib": (obj("red", "red")[15:], MTL, OBJECT, "names no MTL file by mtllib"),
    "no usemtl": (obj("", ""), MTL, OBJECT, "uses no materials of its own (usemtl)"),
    "some without": (obj("", "red"), MTL, OBJECT, "12 triangles have no material"),
    "no such part": (obj("red", "red"), MTL, OBJECT + 'part = "rod"\n', "unknown part 'rod'"),
    "open glass": (
        obj("red", "a lamp", cut=1),
        MTL + "illum 4",
        OBJECT,
        "objects[2].file: models/two.obj: part 'a lamp': 3 edges belong to one triangle",
    ),
    "too bright": (
        obj("red", "a lamp"),
        MTL + "Ke 1e15",
        "[lights]\nworks = 1e15\n" + OBJECT,
        "the intensity times the emission",
    ),
    "nothing wrong with closed glass": (obj("red", "a lamp"), MTL + "illum 4", OBJECT, ""),
    "nothing wrong with a color too bright": (
        obj("red", "red"),
        MTL + "newmtl b\nKd 1 2 3",
        OBJECT,
        "",
    ),
    "nothing wrong with a part": (obj("red", "rod"), MTL, OBJECT + 'part = "red"\n', ""),
}


@pytest.mark.slow_cases("nothing wrong with closed glass")
@pytest.mark.parametrize("name", WRONG)
def test_what_is_wrong_is_one_paragraph(
    folder: Path, capsys: pytest.CaptureFixture[str], name: str
) -> None:
    mesh, materials, thing, message = WRONG[name]
    (folder / "models/two.obj").write_text(mesh)
    (folder / "models/two.mtl").write_text(materials)
    (folder / "scene.toml").write_text(HEAD + MATTE + thing + BALL)
    code = render(folder / "scene.toml", folder / "a.npy")
    told = capsys.readouterr().err
    assert message in told
    assert code == (2 if message else 0), told
    assert told.count("\n") <= 1


def test_a_file_outside_is_read_where_the_user_allows_it(folder: Path) -> None:
    (folder / "models/two.mtl").rename(folder.parent / "far.mtl")
    (folder / "models/two.obj").write_text(obj("red", "red", library="../../far.mtl"))
    assert render(folder / "scene.toml", folder / "a.npy", "--allow-outside") == 0


def test_libraries_have_blanks_or_are_several() -> None:
    text = b"mtllib a b.mtl\r\nmtllib c.mtl d.MTL\n# mtllib e.mtl\nmtllib odd\nmtllib c.mtl\n"
    assert libraries(text) == ["a b.mtl", "c.mtl", "d.MTL", "odd"]


def test_objects_of_one_file_share_its_materials(folder: Path) -> None:
    objects = OBJECT + OBJECT + 'material = "matte"\n' + OBJECT + 'part = "red"\nhidden = true\n'
    (folder / "scene.toml").write_text(HEAD + MATTE + objects)
    scene = glrt.load(folder / "scene.toml")
    found = [(mesh.part, mesh.material.split(":")[-1], mesh.hidden) for mesh in meshes(scene)]
    assert found == [
        ("red", "red", False),
        (None, "matte", False),
        ("red", "red", True),
        ("a lamp", "a lamp", False),
    ]
    assert meshes(scene)[0].triangles is meshes(scene)[2].triangles, "held once"
    assert len(scene.materials) == 3


def test_a_picture_reads_no_mtl_file_that_it_does_not_list(folder: Path) -> None:
    """A recipe made by hand, whose object has no material."""
    scene = glrt.load(folder / "scene.toml")
    bare = scene.objects[0].model_copy(update={"material": "", "part": None})
    expected = {"models/two.obj": meshes(scene)[0].file.sha256 or ""}
    rules = AssetFolder(folder, expected=expected)
    with pytest.raises(SceneError, match=r"does not list 'models/two\.mtl'"):
        with_files(scene.model_copy(update={"objects": (bare,)}), rules, "a.exr")
