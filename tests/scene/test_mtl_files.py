"""MTL files: what becomes of their values, and what is refused with its line."""

import math
import random

import pytest

from glrt.core.errors import SceneError
from glrt.scene.materials.dielectric import Dielectric
from glrt.scene.materials.kinds import Material
from glrt.scene.materials.lambertian import Lambertian
from glrt.scene.materials.metal import Metal
from glrt.scene.materials.principled import Principled
from glrt.scene.materials.textures import Texture
from glrt.scene.model_files.mtl import decode_mtl, material_of

HALF = (0.5, 0.25, 0.125)
_KD, _KS = "Kd 0.5 0.25 0.125\n", "Ks 0.5 0.25 0.125\n"
ROUGH = math.sqrt(math.sqrt(2 / 102))  # of Ns 100

MATERIALS: dict[str, Material] = {
    "": Lambertian(color=(0.8, 0.8, 0.8)),
    _KD: Lambertian(color=HALF),
    "Kd 0.5": Lambertian(color=(0.5, 0.5, 0.5)),
    "Kd -0 0 0": Lambertian(color=(0, 0, 0)),
    "Ke 4 3 2": Lambertian(color=(0, 0, 0), emission=(4, 3, 2)),
    _KD + "Ke 4 3 2": Lambertian(color=HALF, emission=(4, 3, 2)),
    _KD + "Ks 1 1 1\nNs 100\nillum 2": Lambertian(color=HALF),
    "Kd 0 0 0\nNs 100\n" + _KS: Metal(color=HALF, roughness=ROUGH),
    "Kd 1 1 1\nNs 100\nillum 3\n" + _KS: Metal(color=HALF, roughness=ROUGH),
    "Kd 1 1 1\nillum 5\n" + _KS: Metal(color=HALF, roughness=0),
    "Kd 0 0 0\nNs 0\n" + _KS: Metal(color=HALF, roughness=1),
    _KD + "Pm 1\nPr 0.25\nNs 100": Metal(color=HALF, roughness=0.25),
    _KD + "Pm 0.5\nKe 1 1 1": Metal(color=HALF, roughness=0, emission=(1, 1, 1)),
    _KD + "Pm 0.4\nPr 0.25": Lambertian(color=HALF),
    _KD + "illum 3": Lambertian(color=HALF),
    "illum 7\nNi 1.33": Dielectric(ior=1.33),
    "illum 4": Dielectric(ior=1.5),
    "illum 6\nNi 0": Dielectric(ior=1.5),
    "d 0.5\nNi 1.33": Dielectric(ior=1.33),
    "Tr 0.5\nNi 1.33": Dielectric(ior=1.33),
    "d -halo 0.5\nNi 1.33\n" + _KD: Lambertian(color=HALF),
    "d 0.5\nNi 1\n" + _KD: Principled(color=HALF, specular=0, alpha=0.5),
    "illum 4\nd 0.75\n" + _KD: Principled(color=HALF, specular=0, alpha=0.75),
    "Tr 0.25\nNi 1.5\n" + _KD: Principled(color=HALF, specular=0, alpha=0.75),
    "illum 4\nd 1\n" + _KD: Dielectric(ior=1.5),
    "d 1\nTr 0\nNi 1.45\n" + _KD: Lambertian(color=HALF),
}


@pytest.mark.parametrize("text", MATERIALS)
def test_values_become_a_material(text: str) -> None:
    found = decode_mtl(f"# by hand\nnewmtl a thing\n{text}\n".encode(), "here")
    assert list(found) == ["a thing"]
    assert material_of(found["a thing"])[0] == MATERIALS[text]


def test_what_is_left_out_is_named() -> None:
    text = (
        "newmtl a\r\nKa 1 1 1\r\n\tmap_Kd wood.png\r\nKd 1 1 1\r\nKs 1 1 1\r\nd 0.5\r\nTf 1 1 1\r\n"
    )
    found = decode_mtl(text.encode("utf-8-sig"), "here")
    assert material_of(found["a"])[1] == ["Tf", "Ks"]


OF_BLENDER: dict[str, tuple[Principled, list[str]]] = {
    "": (Principled(color=(0.8,) * 3, roughness=0.5), []),
    _KD + "Ns 490\nKs 0.5 0.5 0.5\nillum 2": (Principled(color=HALF, roughness=0.3), []),
    "Ns 40\nKa 0.6 0.6 0.6\nillum 3": (Principled(metallic=0.6, roughness=0.8), []),
    "Ns 1000\nKa 1 1 1\nillum 2": (Principled(roughness=0.0), []),
    "Ks 0 0 0\nillum 1": (Principled(ior=1.0, specular=0.0, roughness=0.5), []),
    "d 0.25\nillum 9\n" + _KD: (Principled(color=HALF, roughness=0.5, alpha=0.25), []),
    "d 0\n" + _KD: (Principled(color=HALF, roughness=0.5), ["d"]),
    "d 0.5\nKe 2 2 2": (Principled(roughness=0.5, emission=(2, 2, 2)), ["d"]),
    "map_Kd a.png": (Principled(color=Texture(image="a.png", factor=(0.8,) * 3)), []),
}


@pytest.mark.parametrize("text", OF_BLENDER)
def test_files_of_blender_mean_principled_materials(text: str) -> None:
    """Ns is 1000 (1 - roughness)^2; a specular level Ks of 0.5 is an index of 1.5; Ka is metal."""
    head = b"# Blender 3.6.1 MTL File: 'None'\n\nnewmtl a\nNi 1.45\n"
    found, unread = material_of(decode_mtl(head + text.encode(), "here")["a"])
    wanted, left_out = OF_BLENDER[text]
    assert isinstance(found, Principled)
    assert unread == left_out
    assert found.color_map == wanted.color_map
    assert found.emission == wanted.emission
    for key in ("metallic", "roughness", "ior", "specular", "alpha"):
        if not (key == "roughness" and "map_Kd" in text):
            assert getattr(found, key) == pytest.approx(getattr(wanted, key), abs=1e-6), key


def test_older_files_of_blender_are_read_as_others() -> None:
    """Before 2.8 it wrote an index of 1, and Phong's exponent."""
    text = b"# Blender MTL File: 'a.blend'\nnewmtl a\nNs 96.078431\nKd 0.64 0.64 0.64\nNi 1.000000"
    found = decode_mtl(text, "here")["a"]
    assert material_of(found)[0] == Lambertian(color=(0.64, 0.64, 0.64))


def test_a_texture_of_what_is_there_in_part_stays() -> None:
    found = decode_mtl(b"newmtl a\nd 0.75\nmap_Kd a.png", "here")["a"]
    shown = material_of(found)[0]
    assert isinstance(shown, Principled)
    assert (shown.alpha, shown.specular) == (0.75, 0.0)
    assert shown.color_map


# A line, the material that it means, and what was left out.
OUT_OF_RANGE: dict[str, tuple[Lambertian | Metal | Dielectric, list[str]]] = {
    "Kd 1.000001 0.25 0.125": (Lambertian(color=(1, 0.25, 0.125)), []),
    "Kd 0.5 -1e-9 0": (Lambertian(color=(0.5, 0, 0)), []),
    "Kd 0.5 0.25 0.125 1.0": (Lambertian(color=HALF), []),
    "Kd 0 0 255": (Lambertian(color=(0, 0, 1)), ["the part of Kd outside 0 to 1"]),
    "Kd 0 0 -1": (Lambertian(color=(0, 0, 0)), ["the part of Kd outside 0 to 1"]),
    "Kd 1 1": (Lambertian(color=(0.8, 0.8, 0.8)), ["Kd"]),
    "Kd": (Lambertian(color=(0.8, 0.8, 0.8)), ["Kd"]),
    "Kd 1 1 red": (Lambertian(color=(0.8, 0.8, 0.8)), ["Kd"]),
    "Kd spectral a.rfl": (Lambertian(color=(0.8, 0.8, 0.8)), ["Kd"]),
    "Kd nan 0 0": (Lambertian(color=(0.8, 0.8, 0.8)), ["Kd"]),
    "Ke 0 0 inf": (Lambertian(color=(0.8, 0.8, 0.8)), ["Ke"]),
    _KD + "Ks 1.2 1.2 1.2": (
        Lambertian(color=HALF),
        ["the part of Ks outside 0 to 1", "Ks"],
    ),
    "Kd 0 0 0\nKs 1 1 1\nNs -1.96": (
        Metal(color=(1, 1, 1), roughness=1),
        ["the part of Ns outside 0 to 1e09"],
    ),
    "illum 4\nNi 11": (Dielectric(ior=10), ["the part of Ni outside 0 to 10"]),
    _KD + "d 1 1": (Lambertian(color=HALF), []),
    _KD + "illum": (Lambertian(color=HALF), ["illum"]),
    _KD + "newmtl a\nKd 0 0 0": (Lambertian(color=HALF), ["another material of the same name"]),
    "Kd 0.5 0.25 0.125 # wood": (Lambertian(color=HALF), []),
}


@pytest.mark.parametrize("text", OUT_OF_RANGE)
def test_what_is_out_of_range_is_moved_into_it_or_left_out(text: str) -> None:
    found = decode_mtl(f"newmtl a # a name\n{text}\n".encode(), "here")
    assert list(found) == ["a"]
    assert material_of(found["a"]) == OUT_OF_RANGE[text]


def test_what_stands_before_the_first_name_is_left_out() -> None:
    found = decode_mtl(b"Kd 0 0 0\nnewmtl a\nKd 0.5\nnewmtl\nKd 0 0 0\nnewmtl b", "here")
    assert list(found) == ["a", "b"]
    left_out = ["what stands before the first newmtl"]
    assert material_of(found["a"]) == (Lambertian(color=(0.5, 0.5, 0.5)), left_out)


IMAGES: dict[str, tuple[str, tuple[float, float], tuple[float, float]]] = {
    "Wall - Diffuse.png": ("Wall - Diffuse.png", (1, 1), (0, 0)),
    "-s 2 4 1 -o 0.5 0.25 0 a b.png": ("a b.png", (2, 4), (0.5, -3.25)),
    "-s 2 t.png": ("t.png", (2, 1), (0, 0)),
    "-clamp on -blendu off t.png": ("t.png", (1, 1), (0, 0)),
    "-s 2 2 1 1.png": ("1.png", (2, 2), (0, -1)),
}


@pytest.mark.parametrize("text", IMAGES)
def test_images_have_options_and_blanks(text: str) -> None:
    """v grows upwards in MTL files: 1 - (s (1 - v) + o) = s v + 1 - s - o."""
    material, left_out = material_of(decode_mtl(f"newmtl a\nmap_Kd {text}".encode(), "here")["a"])
    assert isinstance(material, Lambertian)
    assert material.color_map is not None
    assert material.color_map.image is not None
    found = material.color_map
    assert (material.color_map.image.file, found.scale, found.offset) == IMAGES[text]
    unknown = ("-clamp", "-blendu")
    assert left_out == [f"{word} of map_Kd" for word in text.split() if word in unknown]


def test_a_file_of_absurd_size_is_refused() -> None:
    with pytest.raises(SceneError, match="larger than 16 MiB"):
        decode_mtl(b"#" * ((16 << 20) + 1), "here")


def test_damaged_files_are_read() -> None:
    texts = [f"newmtl a{count}\n{text}" for count, text in enumerate(MATERIALS)]
    whole = "\n".join(texts).encode()
    left_out = 0
    for seed in range(100):
        draw, data = random.Random(seed), bytearray(whole)
        for _ in range(draw.randint(1, 6)):
            start = draw.randrange(len(data))
            more = draw.choice([b"", b"-1 ", b"1e999 ", b"nan ", b"\0", b"\n", b"\xff", b"newmtl "])
            data[start : start + draw.randint(0, 20)] = more
        found = decode_mtl(bytes(data), "here")
        left_out += any(material_of(entry)[1] for entry in found.values())
    assert left_out == 100


@pytest.mark.parametrize("encoding", ["utf-8", "latin-1", "utf-16"])
@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
def test_names_are_read_in_the_encodings_of_obj_files(encoding: str, end: str) -> None:
    text = f"newmtl Grün{end}Kd 0 1 0{end}"
    entry = decode_mtl(text.encode(encoding), "here")["Grün"]
    assert entry.colors == {"Kd": (0, 1, 0)}
