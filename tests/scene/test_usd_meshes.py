"""Meshes of USD files: polygons, normals, transforms, instances and what is not shown."""

from pathlib import Path

import numpy as np
import pytest

import glrt
from glrt.core.errors import SceneError
from tests.support.gltf_files import Builder
from tests.support.usd_files import (
    BINDS,
    COORDINATES,
    SQUARE,
    bound,
    layer,
    left_out,
    moved,
    placed,
    prim,
    scene_of,
    square,
    surface,
)

pytest.importorskip("pxr", reason="usd-core is not installed")


def same_places(found: np.ndarray, *expected: np.ndarray) -> bool:
    """Whether two sets of points are equal."""
    rows = np.unique(found.round(6) + 0.0, axis=0)
    others = np.unique(np.concatenate(expected).round(6) + 0.0, axis=0)
    return rows.shape == others.shape and np.allclose(rows, others)


POINTS = np.array([(-1, 0, 1), (1, 0, 1), (1, 0, -1), (-1, 0, -1)], np.float64)


def areas(scene: glrt.Scene) -> dict[str, float]:
    """The area of the triangles of each material."""
    found = {}
    for mesh in scene.meshes:
        corners = mesh.triangles.vertices[mesh.triangles.faces]
        across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        found[mesh.material.partition(":")[2]] = float(np.linalg.norm(across, axis=1).sum() / 2)
    return found


def facing(scene: glrt.Scene) -> np.ndarray:
    """The unit normals of all triangles, by the order of their corners."""
    mesh = scene.meshes[0].triangles_of_file
    corners = mesh.vertices[mesh.faces]
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    return np.asarray(across / np.linalg.norm(across, axis=1, keepdims=True))


def test_a_square_is_as_in_a_glb_file_to_the_bit(tmp_path: Path) -> None:
    """Same triangles, material, camera and picture."""
    red = "color3f inputs:diffuseColor = (0.8, 0.1, 0.1)\nfloat inputs:roughness = 0.3"
    camera = "float focalLength = 50\nfloat horizontalAperture = 36\nfloat verticalAperture = 36\n"
    text = square(more=COORDINATES, material="/red") + surface("red", red)
    usd = scene_of(tmp_path, layer(text + prim("Camera", "cam", camera + moved(0, 1, 5))))
    builder = Builder()
    look = {"baseColorFactor": [0.8, 0.1, 0.1, 1], "metallicFactor": 0, "roughnessFactor": 0.3}
    material = {"name": "red", "pbrMetallicRoughness": look, "doubleSided": True}
    places = builder.accessor(POINTS)
    primitive = {
        "attributes": {"POSITION": places},
        "indices": builder.accessor([0, 1, 2, 0, 2, 3], "u4"),
        "material": builder.add("materials", material),
    }
    builder.shown(primitive)
    seen = {"yfov": 2 * np.arctan(18 / 50), "aspectRatio": 1.0}
    builder.add("cameras", {"type": "perspective", "perspective": seen})
    builder.json["nodes"].append({"camera": 0, "translation": [0, 1, 5]})
    if builder.json.get("scenes"):
        builder.json["scenes"][0]["nodes"].append(len(builder.json["nodes"]) - 1)
    (tmp_path / "model.glb").write_bytes(builder.glb())
    glb = glrt.load(tmp_path / "model.glb")
    pictures = [glrt.render(scene, samples=2, width=32, height=32).radiance for scene in (usd, glb)]
    assert pictures[0].any()
    assert np.array_equal(pictures[0], pictures[1])


STATED = (("", False), ("bool doubleSided = 0", True), ("bool doubleSided = 1", False))


@pytest.mark.parametrize(("stated", "told"), STATED)
def test_only_a_stated_lack_of_backs_is_reported(tmp_path: Path, stated: str, told: bool) -> None:
    """False is the default of USD, which most programs leave unwritten and show both sides."""
    text = square(more=COORDINATES, material="/red").replace("bool doubleSided = 1", stated)
    red = surface("red", "color3f inputs:diffuseColor = (0.8, 0.1, 0.1)")
    assert ("hidden backs" in left_out(scene_of(tmp_path, layer(text + red)))) == told


INTERPOLATIONS = {  # values, and which of NORMALS each corner has
    "vertex": ("(1, 0, 0), (0, 1, 0), (0, 0, 1), (0, -1, 0)", [0, 1, 2, 3]),
    "varying": ("(0, 1, 0), (1, 0, 0), (0, 0, 1), (0, -1, 0)", [1, 0, 2, 3]),
    "faceVarying": ("(1, 0, 0), (0, 1, 0), (0, 0, 1), (0, 0, 1)", [0, 1, 2, 2]),
    "uniform": ("(0, 0, 1)", [2, 2, 2, 2]),
    "constant": ("(0, -1, 0)", [3, 3, 3, 3]),
}
NORMALS = np.array([(1, 0, 0), (0, 1, 0), (0, 0, 1), (0, -1, 0)])


def test_normals_have_their_interpolation(tmp_path: Path) -> None:
    """Each corner has the normal that the file gives it."""
    text = ""
    for number, (interpolation, (values, _)) in enumerate(INTERPOLATIONS.items()):
        given = f'normal3f[] normals = [{values}] (\ninterpolation = "{interpolation}"\n)\n'
        text += square(f"s{number}", given + moved(10 * number, 0, 0))
    mesh = scene_of(tmp_path, layer(text)).meshes[0].triangles_of_file
    assert mesh.normals is not None
    for number, (_, expected) in enumerate(INTERPOLATIONS.values()):
        for point, normal in zip(POINTS, NORMALS[expected], strict=True):
            at = (mesh.vertices == np.add(point, (10 * number, 0, 0))).all(axis=1)
            assert at.any()
            assert (mesh.normals[at] == normal).all()


def test_left_handed_polygons_face_the_other_way(tmp_path: Path) -> None:
    """Their corners run clockwise, seen from outside."""
    turned = square("turned", 'uniform token orientation = "leftHanded"\n' + moved(9, 0, 0))
    scene = scene_of(tmp_path, layer(square() + turned))
    assert np.allclose(facing(scene), [(0, 1, 0)] * 2 + [(0, -1, 0)] * 2)


def test_concave_polygons_keep_their_outline_and_holes_are_empty(tmp_path: Path) -> None:
    """An L of area 3, and a square that is a hole."""
    body = """
    int[] faceVertexCounts = [6, 4]
    int[] faceVertexIndices = [0, 1, 2, 3, 4, 5, 0, 1, 2, 5]
    int[] holeIndices = [1]
    point3f[] points = [(0, 0, 0), (2, 0, 0), (2, 1, 0), (1, 1, 0), (1, 2, 0), (0, 2, 0)]
    uniform token subdivisionScheme = "none"
    """
    scene = scene_of(tmp_path, layer(prim("Mesh", "L", body)))
    assert sum(areas(scene).values()) == pytest.approx(3, abs=1e-12)
    assert np.allclose(facing(scene), (0, 0, 1))


def test_subsets_of_faces_have_their_own_materials(tmp_path: Path) -> None:
    """Faces in no subset have that of the mesh."""
    body = """
    int[] faceVertexCounts = [4, 4, 3]
    int[] faceVertexIndices = [0, 1, 4, 3, 1, 2, 5, 4, 3, 4, 6]
    point3f[] points = [(0, 0, 0), (1, 0, 0), (3, 0, 0), (0, 1, 0), (1, 1, 0), (3, 1, 0), (0, 2, 0)]
    uniform token subdivisionScheme = "none"
    rel material:binding = </red>
    """
    subset = """
    uniform token elementType = "face"
    uniform token familyName = "materialBind"
    int[] indices = [1]
    rel material:binding = </blue>
    """
    mesh = prim("Mesh", "three", body + prim("GeomSubset", "second", subset, BINDS), BINDS)
    scene = scene_of(tmp_path, layer(mesh + surface("red", "") + surface("blue", "")))
    assert areas(scene) == pytest.approx({"red": 1.5, "blue": 2.0})


def test_files_with_z_up_in_centimetres_stand_upright_in_metres(tmp_path: Path) -> None:
    """The point (1, 2, 3) cm with z up is (0.01, 0.03, -0.02) m."""
    body = """
    int[] faceVertexCounts = [3]
    int[] faceVertexIndices = [0, 1, 2]
    point3f[] points = [(1, 2, 3), (0, 0, 0), (1, 0, 0)]
    """
    scene = scene_of(tmp_path, layer(prim("Mesh", "one", body), up="Z", unit=0.01))
    assert np.allclose(scene.meshes[0].triangles_of_file.vertices[0], (0.01, 0.03, -0.02))


def test_transforms_are_those_of_the_stack(tmp_path: Path) -> None:
    """The last one comes first: scaled, turned about y, moved; then those of the parent."""
    ops = placed(
        ("double3", "translate", "(10, 0, 0)"),
        ("float", "rotateY", "90"),
        ("float3", "scale", "(1, 1, 2)"),
    )
    inner = prim("Mesh", "square", SQUARE + ops)
    scene = scene_of(tmp_path, layer(prim("Xform", "top", moved(0, 5, 0) + inner)))
    expected = POINTS * (1, 1, 2) @ [[0, 0, -1], [0, 1, 0], [1, 0, 0]] + (10, 5, 0)
    found = scene.meshes[0].triangles_of_file.vertices
    assert same_places(found, expected)


def test_points_show_instances_of_prototypes(tmp_path: Path) -> None:
    """With places, turns and scales; hidden ones are left out, and the prototype itself."""
    body = """
    rel prototypes = [</grid/one>]
    int[] protoIndices = [0, 0, 0]
    point3f[] positions = [(0, 0, 0), (10, 0, 0), (20, 0, 0)]
    float3[] scales = [(1, 1, 1), (2, 2, 2), (1, 1, 1)]
    int64[] invisibleIds = [2]
    """
    one = prim("Xform", "one", moved(0, 1, 0) + square())
    scene = scene_of(tmp_path, layer(prim("PointInstancer", "grid", body + one)))
    found = scene.meshes[0].triangles_of_file.vertices
    raised = np.add(POINTS, (0, 1, 0))
    assert same_places(found, raised, np.add(2 * raised, (10, 0, 0)))


def test_scenegraph_instances_share_a_mesh_and_keep_their_places(tmp_path: Path) -> None:
    """Two instances of one prim."""
    about = "instanceable = true\nreferences = </thing>"
    two = "".join(prim("Xform", f"at{x}", moved(x, 0, 0), about) for x in (0, 10))
    text = f'class "thing"\n{{\n{square()}\n}}\n' + two
    scene = scene_of(tmp_path, layer(text))
    found = scene.meshes[0].triangles_of_file.vertices
    assert same_places(found, POINTS, np.add(POINTS, (10, 0, 0)))


def test_what_is_invisible_inactive_or_a_guide_is_not_shown(tmp_path: Path) -> None:
    """And what stands below it."""
    hidden = prim("Xform", "a", 'token visibility = "invisible"\n' + square(more=moved(5, 0, 0)))
    idle = prim("Xform", "b", square(more=moved(6, 0, 0)), "active = false")
    guide = prim("Xform", "c", 'uniform token purpose = "guide"\n' + square(more=moved(7, 0, 0)))
    proxy = prim("Xform", "d", 'uniform token purpose = "proxy"\n' + square(more=moved(8, 0, 0)))
    shown = prim("Xform", "e", 'uniform token purpose = "render"\n' + square())
    scene = scene_of(tmp_path, layer(hidden + idle + guide + proxy + shown))
    assert scene.meshes[0].triangles_of_file.vertices[:, 0].max() == 1


def test_what_is_not_shown_is_reported_by_kind(tmp_path: Path) -> None:
    """Each kind once, with its number."""
    subdivided = prim("Mesh", "cage", SQUARE.replace('"none"', '"catmullClark"'))
    curve = "int[] curveVertexCounts = [2]\npoint3f[] points = [(0, 0, 0), (1, 0, 0)]"
    curves = prim("BasisCurves", "one", curve) + prim("BasisCurves", "two", curve)
    bones = prim("SkelRoot", "body", prim("Skeleton", "bones"))
    grows = "double radius.timeSamples = {\n1: 1,\n2: 3,\n}\n"
    moves = prim("Sphere", "balloon", grows)
    told = left_out(scene_of(tmp_path, layer(subdivided + curves + bones + moves)))
    assert "BasisCurves (2 times)" in told
    assert "subdivision of meshes" in told
    assert "skeletons" in told
    assert "changes over time of 'radius'" in told


def test_colors_of_meshes_without_a_material_are_shown(tmp_path: Path) -> None:
    """displayColor, linear."""
    more = "color3f[] primvars:displayColor = [(0.5, 0.25, 0.125)]"
    scene = scene_of(tmp_path, layer(square(more=more)))
    (mesh,) = scene.meshes
    assert mesh.material.endswith(":displayColor")
    assert mesh.triangles.colors is not None
    assert np.allclose(mesh.triangles.colors, (0.5, 0.25, 0.125))


SOLIDS = {  # keys, and the area
    "Cube": ("double size = 2", 24),
    "Sphere": ("double radius = 2", 16 * np.pi),
    "Cylinder": ('double height = 4\nuniform token axis = "X"', 10 * np.pi),
    "Cone": ("double height = 4", np.pi * (1 + np.sqrt(17))),
    "Capsule": ("double radius = 1\ndouble height = 2", 8 * np.pi),
    "Plane": ('double width = 2\ndouble length = 6\nuniform token axis = "Y"', 12),
}
HALVES = [(1, 1, 1), (2, 2, 2), (2, 1, 1), (1, 1, 2), (1, 1, 2), (1, 0, 3)]


def test_solids_have_their_size_and_face_outwards(tmp_path: Path) -> None:
    """64 sides around: areas to 0.5 %."""
    text = ""
    for number, (kind, (body, _)) in enumerate(SOLIDS.items()):
        own = bound(f"/of{kind}") + moved(10 * number, 0, 0)
        text += prim(kind, kind, f"{body}\n{own}", BINDS) + surface(f"of{kind}", "")
    scene = scene_of(tmp_path, layer(text))
    expected = {f"of{kind}": area for kind, (_, area) in SOLIDS.items()}
    assert areas(scene) == pytest.approx(expected, rel=5e-3)
    for number, (mesh, half) in enumerate(zip(scene.meshes, HALVES, strict=True)):
        points = np.subtract(mesh.triangles.vertices, (10 * number, 0, 0))
        assert np.allclose(points.min(axis=0), np.negative(half))
        assert np.allclose(points.max(axis=0), half)
        corners = points[mesh.triangles.faces]
        across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        middles = corners.mean(axis=1) if half[1] else np.array([[0, 1, 0]])
        assert ((across * middles).sum(axis=1) > 0).all()


def test_damaged_geometry_is_refused_by_the_name_of_the_mesh(tmp_path: Path) -> None:
    """A corner that is none of the points, and a point that is no number."""
    lost = square().replace("[0, 1, 2, 3]", "[0, 1, 2, 9]")
    with pytest.raises(SceneError, match="'/square' has corners that are none of its points"):
        scene_of(tmp_path, layer(lost))
    nowhere = square().replace("(1, 0, -1)", "(nan, 0, -1)")
    with pytest.raises(SceneError, match="'/square' has a point that is no number"):
        scene_of(tmp_path, layer(nowhere))


def test_normals_that_are_no_numbers_are_means(tmp_path: Path) -> None:
    """And reported."""
    more = "normal3f[] normals = [(0, 1, 0), (nan, 0, 0), (0, 1, 0), (0, 1, 0)] (\n"
    scene = scene_of(tmp_path, layer(square(more=more + 'interpolation = "vertex"\n)')))
    assert np.allclose(scene.meshes[0].triangles_of_file.shading_normals, (0, 1, 0))
    assert "normals" in left_out(scene)
