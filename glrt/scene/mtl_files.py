"""MTL files: the materials of OBJ files, as those of a scene.

Keys after Wavefront's "Advanced Visualizer" manual, appendix B1, and the extension for physically
based rendering (`Pr`, `Pm`). docs/how-to/models.md says what becomes of each.
"""

import math
import re
from dataclasses import dataclass, field

from glrt.errors import SceneError
from glrt.scene.materials import Dielectric, Lambertian, Material, Metal
from glrt.scene.textures import Texture
from glrt.scene.values import BLACK, LARGEST, WHITE, Color, Radiance
from glrt.text import number, quoted

LONGEST = 16 << 20  # bytes of a file

_COLORS = {"Kd": 1.0, "Ks": 1.0, "Ke": LARGEST}  # the largest value of each
_NUMBERS = {"Ns": 1e9, "Ni": 10.0, "d": 1.0, "Tr": 1.0, "illum": 10.0, "Pr": 1.0, "Pm": 1.0}
_SILENT = {"Ka"}  # the colour of ambient light, which has no meaning here
_GLASS, _MIRRORS = (4, 6, 7, 9), (3, 5)  # models of `illum`
_USUAL_IOR = 1.5  # where Ni is not given
_LEAST_IOR = 1e-3
_GREY = (0.8, 0.8, 0.8)  # where no colour is given
_LONGEST_PATH = 500  # letters of the path of an image
_CONTROL = re.compile(r"[\x00-\x1f\x7f]")


@dataclass
class Entry:
    """What a file says of a material, by key, and the keys that are not read."""

    colors: dict[str, Radiance] = field(default_factory=dict)
    numbers: dict[str, float] = field(default_factory=dict)
    unread: dict[str, None] = field(default_factory=dict)
    image: str = ""  # of the diffuse colour: a path from the file


def decode_mtl(content: bytes, where: str) -> dict[str, Entry]:
    """The materials in an MTL file, by name.

    Raises `SceneError`, which begins with `where` and the number of the line.
    """
    if len(content) > LONGEST:
        raise SceneError(f"{where}: this MTL file is larger than {LONGEST >> 20} MiB.")
    found: dict[str, Entry] = {}
    entry = None
    for count, line in enumerate(content.decode("utf-8-sig", "replace").split("\n"), 1):
        key, _, rest = line.strip().replace("\t", " ").partition(" ")
        if not key or key.startswith("#"):
            continue
        try:
            if key == "newmtl":
                entry = _new(rest.strip(), found)
            elif entry is None:
                raise ValueError(f"{quoted(key)} stands before the first newmtl")
            else:
                _read(key, rest.split(), entry)
        except ValueError as error:
            raise SceneError(f"{where}, line {count}: {error}. Correct that line.") from None
    return found


def _new(name: str, found: dict[str, Entry]) -> Entry:
    if not name or _CONTROL.search(name):
        raise ValueError("newmtl needs a name, without control characters")
    if name in found:
        raise ValueError(f"a second material has the name {quoted(name)}")
    return found.setdefault(name, Entry())


def _read(key: str, words: list[str], entry: Entry) -> None:
    if key in _COLORS:
        values = [_number(key, word, _COLORS[key]) for word in words]
        if len(values) not in (1, 3):
            raise ValueError(f"{key} needs three numbers, or one for grey")
        red, green, blue = values * (3 // len(values))
        entry.colors[key] = (red, green, blue)
    elif key in _NUMBERS and words[:1] != ["-halo"]:
        if len(words) != 1:
            raise ValueError(f"{key} needs one number")
        entry.numbers[key] = _number(key, words[0], _NUMBERS[key])
    elif key == "map_Kd" and words and not any(word.startswith("-") for word in words):
        entry.image = _image(" ".join(words))
    elif key not in _SILENT:
        entry.unread[key] = None


def _image(path: str) -> str:
    if _CONTROL.search(path) or len(path) > _LONGEST_PATH:
        raise ValueError("map_Kd needs the path of an image, without control characters")
    return path.replace("\\", "/")


def _number(key: str, word: str, largest: float) -> float:
    try:
        value = float(word)
    except ValueError:
        value = math.nan
    if not 0 <= value <= largest:
        raise ValueError(
            f"{key} must be of numbers from 0 to {number(largest)}, got {quoted(word)}"
        )
    return value + 0.0  # without a negative zero


def material_of(entry: Entry, folder: str = "") -> tuple[Material, list[str]]:
    """The material of a scene that is nearest, and the keys that it leaves out.

    `folder` of the file, with '/' at its end, is where its images lie.
    """
    colors, numbers, unread = entry.colors, entry.numbers, list(entry.unread)
    emission = colors.get("Ke", BLACK)
    if _is_glass(numbers):
        ior = numbers.get("Ni", 0.0)
        left_out = ["Ke"] if any(emission) else []
        return Dielectric(ior=ior if ior >= _LEAST_IOR else _USUAL_IOR), unread + left_out
    if _opacity(numbers) < 1:
        unread.append("d" if "d" in numbers else "Tr")
    gloss: Color = colors.get("Ks", BLACK)
    is_grey = not any(gloss) and not any(emission)
    diffuse: Color = colors.get("Kd", _GREY if is_grey else BLACK)
    color: Color | Texture = diffuse
    if entry.image:
        factor = diffuse if any(diffuse) else WHITE  # many programs write 0 beside an image
        color = Texture(image=folder + entry.image, factor=factor)
    if numbers.get("Pm", 0.0) >= 0.5:
        return Metal(color=color, roughness=_roughness(numbers), emission=emission), unread
    if any(gloss) and (numbers.get("illum") in _MIRRORS or not (any(diffuse) or entry.image)):
        return Metal(color=gloss, roughness=_roughness(numbers), emission=emission), unread
    if any(gloss):
        unread.append("Ks")
    return Lambertian(color=color, emission=emission), unread


def _opacity(numbers: dict[str, float]) -> float:
    return numbers.get("d", 1 - numbers.get("Tr", 0.0))


def _is_glass(numbers: dict[str, float]) -> bool:
    is_clear = _opacity(numbers) < 1 and numbers.get("Ni", 0.0) > 1
    return is_clear or numbers.get("illum") in _GLASS


def _roughness(numbers: dict[str, float]) -> float:
    """Pr; else of Phong's exponent, alpha = sqrt(2 / (Ns + 2)); 0 where neither is given.

    B. Walter et al., "Microfacet Models for Refraction through Rough Surfaces", 2007, section 5.2.
    """
    if "Ns" not in numbers:
        return numbers.get("Pr", 0.0)
    alpha = math.sqrt(2 / (numbers["Ns"] + 2))
    return numbers.get("Pr", math.sqrt(alpha))
