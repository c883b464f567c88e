"""USD files as text, of a few things."""

import zipfile
from pathlib import Path
from typing import Any

import glrt

SQUARE = """
    int[] faceVertexCounts = [4]
    int[] faceVertexIndices = [0, 1, 2, 3]
    point3f[] points = [(-1, 0, 1), (1, 0, 1), (1, 0, -1), (-1, 0, -1)]
    uniform token subdivisionScheme = "none"
    bool doubleSided = 1
"""
COORDINATES = """
    texCoord2f[] primvars:st = [(0, 0), (1, 0), (1, 1), (0, 1)] (
        interpolation = "vertex"
    )
"""


def layer(body: str, up: str = "Y", unit: float = 1.0, more: str = "") -> str:
    """A file: its prims, which axis is up, and meters of a unit."""
    return f'#usda 1.0\n(\n    upAxis = "{up}"\n    metersPerUnit = {unit}\n{more}\n)\n{body}\n'


def prim(kind: str, name: str, body: str = "", about: str = "") -> str:
    """A prim with what stands in it; `about` is its metadata."""
    stated = f" (\n{about}\n)" if about else ""
    return f'def {kind} "{name}"{stated}\n{{\n{body}\n}}\n'


def bound(path: str) -> str:
    """Metadata and a relationship cannot stand in one place: the relationship to a material."""
    return f"rel material:binding = <{path}>\n"


BINDS = 'prepend apiSchemas = ["MaterialBindingAPI"]'


def placed(*ops: tuple[str, str, str]) -> str:
    """Transforms: type, name and value each, the outermost first."""
    lines = [f"{kind} xformOp:{name} = {value}" for kind, name, value in ops]
    names = ", ".join(f'"xformOp:{name}"' for _, name, _ in ops)
    return "\n".join(["", *lines, f"uniform token[] xformOpOrder = [{names}]"]) + "\n"


def moved(x: float, y: float, z: float) -> str:
    """A transform that moves."""
    return placed(("double3", "translate", f"({x}, {y}, {z})"))


def surface(name: str, inputs: str, nodes: str = "", outputs: str = "") -> str:
    """A material of a UsdPreviewSurface; nodes of textures stand next to it."""
    shader = prim(
        "Shader",
        "surface",
        f'uniform token info:id = "UsdPreviewSurface"\n{inputs}\ntoken outputs:surface',
    )
    output = f"token outputs:surface.connect = </{name}/surface.outputs:surface>\n"
    return prim("Material", name, output + outputs + shader + nodes)


def texture(path: str, image: str, reads: str = "rgb", inputs: str = "", **more: str) -> str:
    """Nodes below a material: an image named by its key, and what its coordinates are."""
    material, _, name = path.strip("/").partition("/")
    st = more.get("st", f"/{material}/st.outputs:result")
    kind = "float3" if reads == "rgb" else "float"
    return prim(
        "Shader",
        name,
        f'uniform token info:id = "UsdUVTexture"\nasset inputs:file = @{image}@\n'
        f"float2 inputs:st.connect = <{st}>\n{inputs}\n{kind} outputs:{reads}",
    )


def reader(name: str = "st", node: str = "st") -> str:
    """A node that reads texture coordinates by their name."""
    return prim(
        "Shader",
        node,
        'uniform token info:id = "UsdPrimvarReader_float2"\n'
        f'string inputs:varname = "{name}"\nfloat2 outputs:result',
    )


def square(name: str = "square", more: str = "", material: str = "") -> str:
    """A square in y = 0, from -1 to 1, that faces up."""
    body = f"{SQUARE}{more}\n" + (bound(material) if material else "")
    return prim("Mesh", name, body, BINDS if material else "")


def scene_of(folder: Path, text: str, **rules: Any) -> glrt.Scene:
    """The scene of a file."""
    file = folder / "model.usda"
    file.write_text(text)
    return glrt.load(file, **rules)


def left_out(scene: glrt.Scene) -> str:
    """The parts of the file of a scene that are left out, in words."""
    return "; ".join(scene.meshes[0].file.unread)


def package(path: Path, files: dict[str, bytes]) -> Path:
    """A .usdz file: stored without compression, each content at a multiple of 64 bytes."""
    with zipfile.ZipFile(path, "w", zipfile.ZIP_STORED) as archive:
        for name, content in files.items():
            assert archive.fp is not None
            info = zipfile.ZipInfo(name)
            start = archive.fp.tell() + 30 + len(name)
            room = -start % 64
            info.extra = b"" if room == 0 else bytes(2) + (room - 4 & 0xFFFF).to_bytes(2, "little")
            if 0 < room < 4:
                room += 64
                info.extra = bytes(2) + (room - 4).to_bytes(2, "little")
            info.extra = info.extra.ljust(room, b"\0")
            archive.writestr(info, content)
    return path
