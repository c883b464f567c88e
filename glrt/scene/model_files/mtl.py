"""MTL files: the materials of OBJ files, as those of a scene.

Keys follow Wavefront's "Advanced Visualizer" manual, appendix B1, and the extension for physically
based rendering (`Pr`, `Pm`). docs/how-to/models.md says what becomes of each.
"""

import math
import re
from dataclasses import dataclass, field

from glrt.core.errors import SceneError
from glrt.core.text import number
from glrt.scene.materials.dielectric import Dielectric
from glrt.scene.materials.kinds import Material
from glrt.scene.materials.lambertian import Lambertian
from glrt.scene.materials.metal import Metal
from glrt.scene.materials.principled import Principled
from glrt.scene.materials.textures import Texture
from glrt.scene.model_files.text_lines import lines_of
from glrt.scene.values import BLACK, LARGEST, WHITE, Color, Radiance

LONGEST = 16 << 20  # bytes of a file
ROUNDING = 1e-3  # how far out of its range a value may be by rounding

_COLORS = {"Kd": 1.0, "Ks": 1.0, "Ke": LARGEST}  # largest value of each key
_NUMBERS = {"Ns": 1e9, "Ni": 10.0, "d": 1.0, "Tr": 1.0, "illum": 10.0, "Pr": 1.0, "Pm": 1.0}
_AMBIENT = "Ka"  # the colour of ambient light, which has a meaning in files of Blender alone
_GLASS, _MIRRORS = (4, 6, 7, 9), (3, 5)  # models of `illum`
_USUAL_IOR = 1.5  # where Ni is missing
_CLEAR = 0.5  # opacity from which on a surface is no glass, but there in part
_SHARPEST = 1000.0  # Ns that Blender writes for a roughness of 0
_BRIGHTEST = 0.08  # reflectance head-on that Blender writes as a Ks of 1
_LEAST_IOR = 1e-3
_GREY = (0.8, 0.8, 0.8)  # where no colour is given
_LONGEST_PATH = 500  # letters of the path of an image
_CONTROL = re.compile(r"[\x00-\x1f\x7f]")
_COMMENT = re.compile(r"\s#\s.*$")  # names may have a '#' within
_NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")
_PLACING, _MOST_PLACING = ("-s", "-o"), 1e6
_OPTIONS = {  # options of images, and the most arguments of each
    "-s": 3,
    "-o": 3,
    "-t": 3,
    "-mm": 2,
    "-bm": 1,
    "-boost": 1,
    "-texres": 1,
    **dict.fromkeys(("-blendu", "-blendv", "-cc", "-clamp"), 1),
}


@dataclass
class Entry:
    """The keys of a material in a file, and the names of keys that are left out."""

    colors: dict[str, Radiance] = field(default_factory=dict)
    numbers: dict[str, float] = field(default_factory=dict)
    unread: dict[str, None] = field(default_factory=dict)
    by_blender: bool = False  # whether the file says that Blender wrote it
    image: str = ""  # path of the diffuse colour's image, from the file
    placing: dict[str, tuple[float, ...]] = field(default_factory=dict)  # of the image: u or u, v


def decode_mtl(content: bytes, where: str) -> dict[str, Entry]:
    """Return the materials in an MTL file, by name: the first of each.

    A value out of range is moved into it, and what cannot be read is left out; entries say so.
    Raises `SceneError`, which begins with `where`, for a file that is too large.
    """
    if len(content) > LONGEST:
        raise SceneError(f"{where}: this MTL file is larger than {LONGEST >> 20} MiB.")
    found: dict[str, Entry] = {}
    entry, early, by_blender = None, dict[str, None](), False
    for line in lines_of(content):
        key, _, rest = _COMMENT.sub("", line).strip().partition(" ")
        if not key or key.startswith("#"):
            by_blender |= "Blender" in line
            continue
        if key == "newmtl":
            name = _CONTROL.sub("", rest).strip()
            entry, early = Entry(unread=early, by_blender=by_blender), {}
            if name in found:
                found[name].unread["another material of the same name"] = None
            elif name:
                found[name] = entry
        elif entry is None:
            early["what stands before the first newmtl"] = None
        else:
            _read(key, rest.split(), entry)
    return found


def _read(key: str, words: list[str], entry: Entry) -> None:
    if key in _COLORS:
        values = _in_range(key, words[:3], _COLORS[key], entry)
        if len(values) in (1, 3):
            red, green, blue = values * (3 // len(values))
            entry.colors[key] = (red, green, blue)
        else:
            entry.unread[key] = None
    elif key in _NUMBERS and words[:1] != ["-halo"]:
        if values := _in_range(key, words[:1], _NUMBERS[key], entry):
            entry.numbers[key] = values[0]
        else:
            entry.unread[key] = None
    elif key == "map_Kd":
        _read_image(words, entry)
    elif key == _AMBIENT:
        values = _in_range(key, words[:3], 1.0, Entry())
        entry.numbers[key] = sum(values) / len(values) if values else 0.0
    else:
        entry.unread[key] = None


def _in_range(key: str, words: list[str], largest: float, entry: Entry) -> list[float]:
    """Return the numbers of a key, moved into its range; none if a word is no finite number."""
    try:
        given = [float(word) for word in words]
    except ValueError:
        return []
    if not all(map(math.isfinite, given)):
        return []
    values = [min(max(value, 0.0), largest) + 0.0 for value in given]  # no negative zero
    if any(abs(a - b) > ROUNDING * min(largest, 1) for a, b in zip(given, values, strict=True)):
        entry.unread[f"the part of {key} outside 0 to {number(largest)}"] = None
    return values


def _read_image(words: list[str], entry: Entry) -> None:
    """Read the image of map_Kd behind its options; the path may have blanks, and words with '-'."""
    rest = list(words)
    while rest and rest[0] in _OPTIONS:
        option, most = rest[0], _OPTIONS[rest[0]]
        count = next((k for k in range(most) if not _is_argument(rest[1 + k : 2 + k])), most)
        given, rest = rest[1 : 1 + count], rest[1 + count :]
        values = [float(word) for word in given if _NUMBER.fullmatch(word)]
        if option in _PLACING and values and max(map(abs, values)) <= _MOST_PLACING:
            entry.placing[option] = (values[0], *values[1:2])
        else:
            entry.unread[f"{option} of map_Kd"] = None
    path = _CONTROL.sub("", " ".join(rest))
    if path and len(path) <= _LONGEST_PATH:
        entry.image = path
    else:
        entry.unread["map_Kd"] = None


def _is_argument(words: list[str]) -> bool:
    """Return whether the next word belongs to an option: a number, or a switch."""
    return bool(words) and (words[0] in ("on", "off") or bool(_NUMBER.fullmatch(words[0])))


def material_of(entry: Entry) -> tuple[Material, list[str]]:
    """Return the nearest material of a scene, and the keys that it leaves out."""
    colors, numbers, unread = entry.colors, entry.numbers, list(entry.unread)
    emission = colors.get("Ke", BLACK)
    if entry.by_blender and numbers.get("Ni", 1.0) > 1:
        return _of_blender(entry, emission, unread)
    if _is_glass(numbers):
        ior = numbers.get("Ni", 0.0)
        left_out = ["Ke"] if any(emission) else []
        return Dielectric(ior=ior if ior >= _LEAST_IOR else _USUAL_IOR), unread + left_out
    gloss: Color = colors.get("Ks", BLACK)
    is_grey = not any(gloss) and not any(emission)
    diffuse: Color = colors.get("Kd", _GREY if is_grey else BLACK)
    color = _color(entry, diffuse)
    is_mirror = numbers.get("illum") in _MIRRORS or not (any(diffuse) or entry.image)
    if (is_metal := numbers.get("Pm", 0.0) >= 0.5) or (any(gloss) and is_mirror):
        unread += _transparency(numbers)
        shown = color if is_metal else gloss
        return Metal(color=shown, roughness=_roughness(numbers), emission=emission), unread
    if any(gloss):
        unread.append("Ks")
    alpha = _alpha(numbers, emission, unread)
    if alpha < 1:
        return Principled(color=color, specular=0.0, alpha=alpha), unread
    return Lambertian(color=color, emission=emission), unread


def _of_blender(entry: Entry, emission: Radiance, unread: list[str]) -> tuple[Material, list[str]]:
    """Return the principled material that Blender 2.8 or newer wrote, by what its importer reads.

    Ns is 1000 (1 - roughness)^2, Ks the specular level, Ka the metallic share where illum is 3.
    """
    numbers = entry.numbers
    gloss = entry.colors.get("Ks", (0.5, 0.5, 0.5))
    root = math.sqrt(_BRIGHTEST * sum(gloss) / 3)
    sharp = min(numbers.get("Ns", _SHARPEST / 4) / _SHARPEST, 1.0)
    alpha = _alpha(numbers, emission, unread)
    made = Principled(
        color=_color(entry, entry.colors.get("Kd", _GREY)),
        metallic=numbers.get(_AMBIENT, 1.0) if numbers.get("illum") in _MIRRORS else 0.0,
        roughness=1 - math.sqrt(sharp),
        ior=(1 + root) / (1 - root),
        specular=1.0 if any(gloss) else 0.0,
        alpha=alpha,
        emission=emission,
    )
    return made, unread


def _color(entry: Entry, diffuse: Color) -> Color | Texture:
    if not entry.image:
        return diffuse
    factor = diffuse if any(diffuse) else WHITE  # many programs write 0 with an image
    scale, offset = _placing(entry)
    return Texture(image=entry.image, factor=factor, scale=scale, offset=offset)


def _alpha(numbers: dict[str, float], emission: Radiance, unread: list[str]) -> float:
    """Return the share of a surface that is there; 1 for a lamp, and for one that would be gone.

    Some programs write 0 for what is opaque.
    """
    alpha = _opacity(numbers)
    if alpha == 0 or any(emission):
        unread += _transparency(numbers)
        return 1.0
    return alpha


def _transparency(numbers: dict[str, float]) -> list[str]:
    """Return the key by which a surface is transparent, if one is there."""
    return ["d" if "d" in numbers else "Tr"] if _opacity(numbers) < 1 else []


def _placing(entry: Entry) -> tuple[tuple[float, float], tuple[float, float]]:
    """Return scale and offset of an image: v grows upwards in MTL files, and downwards here."""
    scale_u, scale_v = (*entry.placing.get("-s", ()), 1.0, 1.0)[:2]
    offset_u, offset_v = (*entry.placing.get("-o", ()), 0.0, 0.0)[:2]
    return (scale_u, scale_v), (offset_u, 1 - scale_v - offset_v)


def _opacity(numbers: dict[str, float]) -> float:
    return numbers.get("d", 1 - numbers.get("Tr", 0.0))


def _is_glass(numbers: dict[str, float]) -> bool:
    opacity = _opacity(numbers)
    if numbers.get("illum") in _GLASS:
        return opacity <= _CLEAR or opacity == 1
    return opacity <= _CLEAR and numbers.get("Ni", 0.0) > 1


def _roughness(numbers: dict[str, float]) -> float:
    """Return Pr, else the root of alpha = sqrt(2 / (Ns + 2)) of Phong's exponent; 0 without both.

    B. Walter et al., "Microfacet Models for Refraction through Rough Surfaces", 2007, section 5.2.
    """
    if "Ns" not in numbers:
        return numbers.get("Pr", 0.0)
    alpha = math.sqrt(2 / (numbers["Ns"] + 2))
    return numbers.get("Pr", math.sqrt(alpha))
