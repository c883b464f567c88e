"""Files of models and images with faults, by their format: values, words and bytes."""

import io
import time
from copy import deepcopy
from pathlib import Path
from typing import Any

import numpy as np
from hypothesis import strategies as st
from PIL import Image as Pillow

from glrt.core.errors import GlrtError
from glrt.image.sources import load
from glrt.scene.files.named_grids import decode_grid
from glrt.scene.files.named_meshes import mesh_of_arrays
from glrt.scene.images.image_files import decode_image
from tests.fuzz.checks import check_refusal
from tests.fuzz.mutation import JUNK, places
from tests.fuzz.pictures import broken
from tests.support.gltf_files import COLORS, Builder, square
from tests.support.image_bytes import exr, flat_hdr, rle_hdr
from tests.support.meshes import box

Case = tuple[str, bytes]  # the suffix of a file, and its content

LONGEST = 5.0  # seconds of the processor to read a small file, whatever it claims
_POINTS, _FACES = box([-1, -1, -1], [1, 1, 1])
_WORDS = [
    *("-1", "0", "1e999", "nan", "inf", "-0", "99999999999999999999", "1e-320", "1/", "/1", "//"),
    *("1/1/1/1", "f", "v", "vt", "s", "off", "usemtl", "mtllib", "list", "uchar", "double", "face"),
    *("vertex", "endloop", "facet", "end_header", "element", "0x10", "1_0", "1,0", "ü", "\\", "#"),
    *("-3 -2 -1", "newmtl", "map_Kd", "-s", "illum", "9" * 400, "\x00", "\t\t", "format"),
]


def whole_texts() -> dict[str, str]:
    """A sound file of each format in text, by its suffix."""
    vertices = [f"v {x} {y} {z} 1 0.5 0" for x, y, z in _POINTS]
    faces = [f"f {a + 1}/{a % 3 + 1}/1 {b + 1}/1/1 {c - 8}//1" for a, b, c in _FACES]
    obj = ["mtllib thing.mtl", *vertices, "vt 0 0", "vt 1 0", "vt 0 1", "vn 0 0 1", "s 1"]
    ply = ["ply", "format ascii 1.0", f"element vertex {len(_POINTS)}"]
    ply += [f"property float {axis}" for axis in "xyz"] + ["property uchar red"]
    ply += [f"element face {len(_FACES)}", "property list uchar int vertex_indices", "end_header"]
    ply += [f"{x} {y} {z} 7" for x, y, z in _POINTS] + [f"3 {a} {b} {c}" for a, b, c in _FACES]
    stl = ["solid thing"]
    for face in _FACES:
        stl += ["facet normal 0 0 0", "outer loop"]
        stl += [f"vertex {x} {y} {z}" for x, y, z in _POINTS[face]] + ["endloop", "endfacet"]
    mtl = [
        "newmtl red",
        "Kd 1 0 0",
        "Ks 1 1 1",
        "Ns 100",
        "illum 2",
        "map_Kd -s 2 2 1 -clamp on t.png",
    ]
    texts = {
        ".obj": [*obj, "usemtl red", *faces[:6], "usemtl other", "s off", *faces[6:]],
        ".ply": ply,
        ".stl": [*stl, "endsolid thing"],
        ".mtl": [*mtl, "newmtl glass", "d 0.5", "Ni 1.5", "Ke 0 0 0", "Pr 0.5", "Pm 1"],
    }
    return {suffix: "\n".join(lines) + "\n" for suffix, lines in texts.items()}


@st.composite
def texts(draw: st.DrawFn) -> Case:
    """A file in text with one to four of its words, or of its lines, changed."""
    suffix, whole = draw(st.sampled_from(sorted(whole_texts().items())))
    lines = whole.split("\n")
    for _ in range(draw(st.integers(1, 4))):
        at = draw(st.integers(0, len(lines) - 1))
        words = lines[at].split(" ")
        place = draw(st.integers(0, len(words) - 1))
        word = draw(st.sampled_from(_WORDS))
        change = draw(st.sampled_from(["word", "word", "word", "more", "less", "drop", "double"]))
        words[place : place + (change == "word") + (change == "less")] = (
            [word] if change in ("word", "more") else []
        )
        new = {"drop": [], "double": [lines[at]] * 3}.get(change, [" ".join(words)])
        lines[at : at + 1] = new
        lines = lines or [""]
    return suffix, "\n".join(lines).encode()


def whole_gltf() -> Builder:
    """A file with most of what glTF has: a skin, targets, an animation, textures, lights."""
    builder = Builder()
    image = {"index": builder.texture(COLORS, wrapS=33071), "texCoord": 0}
    moved = {"KHR_texture_transform": {"scale": [2, 2], "rotation": 1.0}}
    base = {"baseColorTexture": {**image, "extensions": moved}, "baseColorFactor": [1, 1, 1, 0.5]}
    layers = {
        "KHR_materials_ior": {"ior": 1.4},
        "KHR_materials_specular": {"specularFactor": 0.5, "specularColorFactor": [1, 1, 1]},
        "KHR_materials_clearcoat": {"clearcoatFactor": 0.2},
        "KHR_materials_anisotropy": {"anisotropyStrength": 0.2, "anisotropyRotation": 1.0},
        "KHR_materials_iridescence": {"iridescenceFactor": 0.7, "iridescenceIor": 1.4},
        "KHR_materials_sheen": {"sheenColorFactor": [0.5, 0, 1], "sheenRoughnessFactor": 0.4},
        "KHR_materials_diffuse_transmission": {"diffuseTransmissionFactor": 0.5},
        "KHR_materials_transmission": {"transmissionFactor": 0.3},
        "KHR_materials_volume": {"thicknessFactor": 1, "attenuationDistance": 2.0},
        "KHR_materials_dispersion": {"dispersion": 0.5},
    }
    rest = {"alphaMode": "MASK", "normalTexture": image, "doubleSided": False}
    look = builder.add(
        "materials", {"pbrMetallicRoughness": base, "extensions": layers, "name": "a", **rest}
    )
    shine = {"emissiveFactor": [1, 1, 1], "emissiveTexture": image}
    plain = builder.add("materials", {**shine, "extensions": {"KHR_materials_unlit": {}}})
    primitive = square(builder, material=look)
    joints, weights = np.tile([0, 1, 0, 0], (4, 1)), np.tile([0.5, 0.5, 0, 0], (4, 1))
    primitive["attributes"] |= {
        "JOINTS_0": builder.accessor(joints, "u1"),
        "WEIGHTS_0": builder.accessor(weights),
        "COLOR_0": builder.accessor(np.full((4, 4), 255), "u1", normalized=True),
    }
    primitive["targets"] = [{"POSITION": builder.accessor(np.full((4, 3), 0.1))}]
    variants = [{"material": plain, "variants": [0]}]
    primitive["extensions"] = {"KHR_materials_variants": {"mappings": variants}}
    bones = [builder.add("nodes", {"translation": [0, 0, k]}) for k in range(2)]
    builder.add("skins", {"joints": bones})
    mesh = builder.add("meshes", {"primitives": [primitive], "weights": [0.5]})
    shown = builder.add("nodes", {"mesh": mesh, "skin": 0, "children": bones})
    simple = builder.shown(square(builder, mode=5), matrix=np.eye(4).ravel().tolist())
    builder.add("cameras", {"type": "perspective", "perspective": {"yfov": 0.6, "znear": 0.1}})
    seen = builder.add("nodes", {"camera": 0, "rotation": [0, 0, 0, 1], "translation": [0, 0, 5]})
    punctual = "KHR_lights_punctual"
    lit = builder.add("nodes", {"extensions": {punctual: {"light": 0}}, "scale": [1, 1, 2]})
    lamps = [{"type": "spot", "intensity": 5, "spot": {"outerConeAngle": 0.5}}]
    sampler = {"input": builder.accessor([0.0, 1.0]), "output": builder.accessor(np.eye(3)[:2])}
    channel = {"sampler": 0, "target": {"node": shown, "path": "translation"}}
    builder.add("animations", {"samplers": [sampler], "channels": [channel], "name": "go"})
    builder.add("scenes", {"nodes": [shown, simple, seen, lit]})
    variant = {"KHR_materials_variants": {"variants": [{"name": "b"}]}}
    builder.json["extensions"] = {punctual: {"lights": lamps}, **variant}
    builder.json["extensionsUsed"] = [punctual, "KHR_materials_variants", "EXT_unknown"]
    return builder


_ODD = st.one_of(
    JUNK,
    st.sampled_from([-1, 2**31, 2**40, 1.5, 5126, 5121, "VEC4", "SCALAR", "LINEAR", {"index": 0}]),
    st.sampled_from([None, [0], [[0, 0]], [1e308] * 3, [1e-320] * 4, [0] * 16, {"extensions": []}]),
)


@st.composite
def values_of_gltf(draw: st.DrawFn) -> Case:
    """A glTF file with one to three of its values replaced, dropped or misnamed."""
    builder = whole_gltf()
    table = builder.json
    for _ in range(draw(st.integers(1, 3))):
        owner, key = draw(st.sampled_from(list(places(table))))
        change = draw(st.sampled_from(["replace", "replace", "replace", "drop", "again"]))
        if change == "replace":
            owner[key] = deepcopy(draw(_ODD))
        elif change == "drop":
            del owner[key]
        elif isinstance(owner, list):
            owner.append(deepcopy(owner[key]))
    if draw(st.booleans()):
        return ".gltf", builder.gltf()
    return ".glb", draw(broken(builder.glb())) if draw(st.booleans()) else builder.glb()


@st.composite
def bytes_of_models(draw: st.DrawFn) -> Case:
    """A binary file of a mesh with wrong bytes."""
    rows = np.zeros(len(_FACES), [("normal", "<f4", 3), ("corner", "<f4", (3, 3)), ("more", "<u2")])
    rows["corner"] = _POINTS[_FACES]
    stl = b"a binary file".ljust(80) + np.uint32(len(_FACES)).tobytes() + rows.tobytes()
    ply = mesh_of_arrays(_POINTS, _FACES, _POINTS).content or b""
    suffix, whole = draw(
        st.sampled_from([(".stl", stl), (".ply", ply), (".glb", whole_gltf().glb())])
    )
    return suffix, draw(broken(whole))


def whole_images() -> dict[str, bytes]:
    """A sound image of each format, and of most ways to store it."""
    noise = np.random.default_rng(2).integers(0, 256, (16, 12, 4)).astype(np.uint8)
    color = Pillow.fromarray(noise[:, :, :3])
    kinds: dict[str, tuple[Any, str, dict[str, Any]]] = {
        "PNG": (Pillow.fromarray(noise), "PNG", {}),
        "palette": (color.convert("P"), "PNG", {"transparency": 3}),
        "16 bits": (Pillow.fromarray(noise[:, :, 0].astype(np.uint16) * 256), "PNG", {}),
        "JPEG": (color, "JPEG", {}),
        "scans": (color, "JPEG", {"progressive": True}),
        "CMYK": (color.convert("CMYK"), "JPEG", {}),
        "WebP": (color, "WEBP", {}),
        "BMP": (color, "BMP", {}),
        "TGA": (color, "TGA", {"compression": "tga_rle"}),
    }
    found = {}
    for name, (image, kind, options) in kinds.items():
        file = io.BytesIO()
        image.save(file, kind, **options)
        found[name] = file.getvalue()
    planes = {name: np.ones((9, 9), np.float32) for name in "RGB"}
    return {**found, "HDR": flat_hdr(noise), "RLE": rle_hdr(noise), "EXR": exr(planes)}


@st.composite
def images(draw: st.DrawFn) -> Case:
    """An image with wrong bytes."""
    name, whole = draw(st.sampled_from(sorted(whole_images().items())))
    return name, draw(broken(whole))


@st.composite
def grids(draw: st.DrawFn) -> Case:
    """The file of a grid with wrong bytes."""
    file = io.BytesIO()
    np.save(file, np.ones((3, 4, 5), np.float32))
    return ".npy", draw(broken(file.getvalue()))


def check_model(case: Case, folder: Path) -> str:
    """Read with all that belongs to it, or refused with one paragraph; how it ended."""
    suffix, content = case
    for name, text in whole_texts().items():
        (folder / f"thing{name}").write_text(text)
    (folder / f"thing{suffix}").write_bytes(content)
    path = folder / f"thing{'.obj' if suffix == '.mtl' else suffix}"
    start = time.process_time()
    try:
        load(path)
    except GlrtError as error:
        check_refusal(str(error), str(path))
        return "refused"
    finally:
        assert time.process_time() - start < LONGEST, "it takes too long"
    return "read"


def check_image(case: Case) -> str:
    """Read as finite numbers, or refused with one paragraph; how it ended."""
    start = time.process_time()
    try:
        pixels = decode_image(case[1], "chance.toml: background.image: a.png")
    except GlrtError as error:
        check_refusal(str(error), "chance.toml")
        return "refused"
    finally:
        assert time.process_time() - start < LONGEST, "it takes too long"
    assert np.isfinite(pixels).all()
    return "read"


def check_grid(case: Case) -> str:
    """Read, or refused with a sentence; how it ended."""
    try:
        decode_grid(case[1])
    except ValueError as error:
        check_refusal(f"chance.npy: {error}", "chance.npy")
        return "refused"
    return "read"
