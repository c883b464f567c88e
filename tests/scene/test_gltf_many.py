"""glTF files of many nodes, images, joints and sets of texture coordinates."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

from glrt.image.sources import load
from glrt.scene.loading import companions
from glrt.scene.materials.principled import Principled
from glrt.scene.model_files.gltf import primitives
from glrt.scene.model_files.gltf.attributes import Attributes
from glrt.scene.model_files.gltf.document import Document
from tests.scene.test_gltf_meshes import decoded
from tests.scene.test_lost_looks import told
from tests.support.gltf_files import COLORS, POINTS, UV, Builder, square, textured_square

MOVES: list[dict[str, Any]] = [
    {"translation": [2, 0, 0]},
    {"rotation": [0, 0, 0.6, 0.8], "scale": [1, 2, -1]},
    {"matrix": [0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1]},
    {},
]


def placed(is_shared: bool, has_normals: bool = True) -> Builder:
    """Nodes of one mesh, or of a mesh each, between others and below them."""
    builder = Builder()
    kinds = [square(builder), square(builder, mode=6, indices=builder.accessor(range(4), "u1"))]
    kinds[1]["attributes"]["POSITION"] = builder.accessor(POINTS + 0.5)
    for kind in kinds if not has_normals else ():
        del kind["attributes"]["NORMAL"]
    first = builder.add("meshes", {"primitives": kinds})
    other = builder.add("meshes", {"primitives": kinds[:1]})
    for number, move in enumerate(MOVES):
        own = first if is_shared else builder.add("meshes", {"primitives": kinds})
        below = {"children": [number + 1]} if number == 0 else {}
        builder.add("nodes", {"mesh": own, **move, **below})
    builder.add("nodes", {"mesh": other, "scale": [3, 3, 3]})
    return builder


@pytest.mark.parametrize("has_normals", [True, False])
def test_nodes_that_share_a_mesh_are_as_nodes_of_a_mesh_each(has_normals: bool) -> None:
    shared, apart = (decoded(placed(it, has_normals)) for it in (True, False))
    for name in ("vertices", "faces", "normals", "uv", "sorts"):
        assert np.array_equal(getattr(shared, name), getattr(apart, name)), name
    assert len(shared.faces) == (4 * 2 + 1) * 2


def test_a_mesh_of_many_nodes_is_read_once(monkeypatch: pytest.MonkeyPatch) -> None:
    read = list[str]()

    def counted(document: Document, table: Any, here: str, weights: Any) -> Any:
        read.append(here)
        return Attributes(document, table, here, weights)

    monkeypatch.setattr(primitives, "Attributes", counted)
    decoded(placed(is_shared=True))
    assert read == [
        "meshes[0].primitives[0]",
        "meshes[0].primitives[1]",
        "meshes[1].primitives[0]",
    ]


def test_a_file_of_many_images_is_parsed_once(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    builder = textured_square(doubleSided=True)
    for number in range(3):
        image = {"index": builder.texture(COLORS[:, ::-1] + number)}
        look = {"pbrMetallicRoughness": {"baseColorTexture": image}}
        builder.shown(square(builder, material=builder.add("materials", look)))
    (tmp_path / "thing.bin").write_bytes(builder.binary)
    (tmp_path / "thing.gltf").write_bytes(builder.gltf("thing.bin"))
    parsed = list[Document]()

    def counted(*given: Any) -> Document:
        parsed.append(Document(*given))
        return parsed[-1]

    monkeypatch.setattr(companions, "Document", counted)
    scene = load(tmp_path / "thing.gltf")
    assert len(parsed) == 1
    looks = [it for it in scene.materials.values() if isinstance(it, Principled)]
    images = [it.color_map.image for it in looks if it.color_map]
    assert len(images) == 4
    assert all(image and set(image.companions) == {"thing.bin"} for image in images)


def test_joints_beyond_the_fourth_move_vertices() -> None:
    builder = Builder()
    primitive = square(builder)
    for number in range(2):
        joints, weights = np.full((4, 4), 4 * number) + np.arange(4), np.zeros((4, 4))
        weights[:, 0] = 3 if number else 1
        primitive["attributes"] |= {
            f"JOINTS_{number}": builder.accessor(joints, "u1"),
            f"WEIGHTS_{number}": builder.accessor(weights),
        }
    builder.shown(primitive, skin=0)
    bones = [builder.add("nodes", {"translation": [0, 0, 8.0 * k]}) for k in range(8)]
    builder.add("skins", {"joints": bones})
    assert_allclose(decoded(builder).vertices, POINTS + np.array([0, 0, 0.75 * 4 * 8]))


def with_sets(used: int, *there: int) -> Builder:
    """A textured square by a set of coordinates, which is halved; others are twice as large."""
    builder = textured_square(doubleSided=True)
    attributes = builder.json["meshes"][0]["primitives"][0]["attributes"]
    del attributes["TEXCOORD_0"]
    for number in there:
        rows = UV * (0.5 if number == used else 2)
        attributes[f"TEXCOORD_{number}"] = builder.accessor(rows)
    base = builder.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]
    base["texCoord"] = used
    return builder


@pytest.mark.parametrize(("used", "there"), [(2, (0, 1, 2)), (3, (3,)), (1, (1,)), (0, (0, 1))])
def test_a_texture_lies_by_any_set_of_coordinates(
    tmp_path: Path, used: int, there: tuple[int, ...]
) -> None:
    (tmp_path / "thing.glb").write_bytes(with_sets(used, *there).glb())
    scene = load(tmp_path / "thing.glb")
    look = scene.materials["thing.glb:painted"]
    assert isinstance(look, Principled)
    assert look.color_map
    mesh = scene.meshes[0].triangles
    assert mesh.uv is not None
    own = mesh.uv[:, 2 * look.color_map.uv :][:, :2]
    assert_allclose(own, UV / 2)
    assert told(scene) == []


def test_a_texture_without_its_coordinates_is_left_out_and_told(tmp_path: Path) -> None:
    (tmp_path / "thing.glb").write_bytes(with_sets(2, 0, 1).glb())
    assert told(load(tmp_path / "thing.glb")) == [
        "baseColorTexture by TEXCOORD_2, which is missing"
    ]
    builder = with_sets(2, 0, 1, 2)
    look = builder.json["materials"][0]
    image = look["pbrMetallicRoughness"]["baseColorTexture"]["index"]
    look["normalTexture"] = {"index": image, "texCoord": 0}
    look["emissiveTexture"] = {"index": image, "texCoord": 1}
    (tmp_path / "thing.glb").write_bytes(builder.glb())
    assert told(load(tmp_path / "thing.glb")) == ["baseColorTexture by TEXCOORD_2, a third set"]


def test_a_hull_that_faces_inwards_is_told(tmp_path: Path) -> None:
    builder = Builder()
    corners = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    faces = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
    hull = builder.add("materials", {"name": "outline", "doubleSided": False})
    for size, order in ((1.0, faces), (1.5, faces[:, ::-1])):
        attributes = {"POSITION": builder.accessor(corners * size)}
        indices = builder.accessor(order.ravel(), "u2")
        more = {"material": hull} if size > 1 else {}
        builder.shown({"attributes": attributes, "indices": indices, **more})
    (tmp_path / "thing.glb").write_bytes(builder.glb())
    backs = "the backs of 'outline', a hull (black inside)"
    assert told(load(tmp_path / "thing.glb")) == [backs]
