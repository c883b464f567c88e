"""MTL files: what becomes of their values, and what is refused with its line."""

import math
import random

import pytest

from glrt.errors import SceneError
from glrt.scene.materials import Dielectric, Lambertian, Metal
from glrt.scene.mtl_files import decode_mtl, material_of

HALF = (0.5, 0.25, 0.125)
_KD, _KS = "Kd 0.5 0.25 0.125\n", "Ks 0.5 0.25 0.125\n"
ROUGH = math.sqrt(math.sqrt(2 / 102))  # of Ns 100

MATERIALS = {
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
    "d 0.5\nNi 1\n" + _KD: Lambertian(color=HALF),
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
    assert material_of(found["a"])[1] == ["Tf", "d", "Ks"]


WRONG = {
    "Kd 1 1 1": "line 1: 'Kd' stands before the first newmtl",
    "newmtl": "line 1: newmtl needs a name",
    "newmtl a\n\nnewmtl a": "line 3: a second material has the name 'a'",
    "newmtl a\nKd 1 1": "line 2: Kd needs three numbers",
    "newmtl a\nKd": "line 2: Kd needs three numbers",
    "newmtl a\nKd 1 1 red": "line 2: Kd must be of numbers from 0 to 1, got 'red'",
    "newmtl a\nKd spectral a.rfl": "line 2: Kd must be",
    "newmtl a\nKd nan 0 0": "line 2: Kd must be of numbers from 0 to 1, got 'nan'",
    "newmtl a\nKd 0 0 -1": "line 2: Kd must be",
    "newmtl a\nKd 0 0 255": "line 2: Kd must be",
    "newmtl a\nKe 0 0 inf": "line 2: Ke must be",
    "newmtl a\nKe 0 0 1e16": "line 2: Ke must be",
    "newmtl a\n# x\nNs 1e99": "line 3: Ns must be",
    "newmtl a\nNi 11": "line 2: Ni must be of numbers from 0 to 10, got '11'",
    "newmtl a\nd 1 1": "line 2: d needs one number",
    "newmtl a\nillum": "line 2: illum needs one number",
}


@pytest.mark.parametrize("text", WRONG)
def test_what_is_wrong_is_refused_with_its_line(text: str) -> None:
    with pytest.raises(SceneError) as caught:
        decode_mtl(text.encode(), "scene.toml: objects[0].file: a.mtl")
    told = str(caught.value)
    assert told.startswith(f"scene.toml: objects[0].file: a.mtl, {WRONG[text]}")
    assert "\n" not in told


def test_a_file_of_absurd_size_is_refused() -> None:
    with pytest.raises(SceneError, match="larger than 16 MiB"):
        decode_mtl(b"#" * ((16 << 20) + 1), "here")


def test_damaged_files_are_read_or_refused() -> None:
    texts = [f"newmtl a{count}\n{text}" for count, text in enumerate(MATERIALS)]
    whole = "\n".join(texts).encode()
    refused = 0
    for seed in range(100):
        draw, data = random.Random(seed), bytearray(whole)
        for _ in range(draw.randint(1, 6)):
            start = draw.randrange(len(data))
            more = draw.choice([b"", b"-1 ", b"1e999 ", b"nan ", b"\0", b"\n", b"\xff", b"newmtl "])
            data[start : start + draw.randint(0, 20)] = more
        told = ""
        try:
            for entry in decode_mtl(bytes(data), "here").values():
                material_of(entry)
        except SceneError as error:
            told = str(error)
        assert not told or told.startswith("here, line ")
        refused += bool(told)
    assert 10 < refused < 100
