"""MaterialX documents as text, of a few materials."""

from pathlib import Path
from typing import Any

import glrt
from glrt.scene.materials.principled import Principled

HEAD = '<?xml version="1.0"?>\n<materialx version="1.39" colorspace="lin_rec709">'


def given(name: str, value: str, kind: str = "float", **more: str) -> str:
    """An input with a value."""
    rest = "".join(f' {key}="{each}"' for key, each in more.items())
    return f'<input name="{name}" type="{kind}" value="{value}"{rest}/>'


def connected(name: str, node: str, kind: str = "float", output: str = "") -> str:
    """An input that a node gives."""
    port = f' output="{output}"' if output else ""
    return f'<input name="{name}" type="{kind}" nodename="{node}"{port}/>'


def node(category: str, name: str, kind: str, *inputs: str) -> str:
    """A node."""
    return f'<{category} name="{name}" type="{kind}">{"".join(inputs)}</{category}>'


def image(name: str, file: str, kind: str = "color3", *inputs: str, **more: str) -> str:
    """A node of an image."""
    space = {"colorspace": "srgb_texture"} if kind == "color3" else {}
    return node("image", name, kind, given("file", file, "filename", **{**space, **more}), *inputs)


def material(name: str, surface: str, *inputs: str) -> str:
    """A material of a surface, which has the inputs."""
    shader = connected("surfaceshader", f"of_{name}", "surfaceshader")
    return node(surface, f"of_{name}", "surfaceshader", *inputs) + node(
        "surfacematerial", name, "material", shader
    )


def document(*parts: str) -> str:
    """A document."""
    return "\n".join([HEAD, *parts, "</materialx>\n"])


def scene_of(folder: Path, *parts: str, **rules: Any) -> glrt.Scene:
    """The scene of a document."""
    file = folder / "looks.mtlx"
    file.write_text(document(*parts))
    return glrt.load(file, **rules)


def look(scene: glrt.Scene, name: str) -> Principled:
    """A material of the document of a scene."""
    found = scene.materials[f"looks.mtlx:{name}"]
    assert isinstance(found, Principled)
    return found


def left_out(scene: glrt.Scene) -> str:
    """The parts of the document of a scene that are left out, in words."""
    return "; ".join(scene.meshes[0].file.unread)
