"""glrt: a physically based path tracer in OpenGL compute shaders.

Importing it loads nothing else: each public name is imported when it is first used.

Modules and packages, each importing only what stands above it:

- version: the version of glrt
- early: Ctrl-C before anything else is imported
- text: words and numbers of the user in messages
- errors: what can go wrong, with the exit code of each kind
- signals: Ctrl-C, SIGTERM and SIGHUP
- silence: what compiled libraries print by themselves
- resources: where shaders and scenes lie
- files: files that appear whole or not at all
- memo: results kept for the same objects
- settings: every render setting, once
- gpu: OpenGL alone, which knows no scene
- scene: frozen models of what is rendered, and TOML in and out
- methods: what a method and a scene need of a kernel, and what a method leaves out
- accel: trees over shapes and groups of lamps; arrays in, arrays out
- error: estimates of the error of a picture, and how far they can be believed
- denoise: filters that know what they leave wrong
- image: pictures in files, with their recipe and the state of their film
- comparison: whether two pictures differ by more than their noise
- rendering: a scene and settings in, samples on a film out
- doctor: which OpenGL routes work on a machine
- analysis: experiments over the renderer: chart, stress, choice of a method
- view: the window
- api: the public functions that are not defined elsewhere
- cli: the commands
- __main__: `python -m glrt`
"""

from glrt.version import VERSION

TYPE_CHECKING = False  # importing `typing` takes 5 ms, in which Ctrl-C would end in a traceback
if TYPE_CHECKING:
    from typing import Any

    from glrt.api import paths, render
    from glrt.comparison.result import Comparison
    from glrt.comparison.verdict import compare
    from glrt.image.image import Image
    from glrt.image.merge import merge
    from glrt.image.sources import load
    from glrt.rendering.path_values import Contribution, Path, PathVertex, PixelPaths
    from glrt.rendering.renderer import Renderer
    from glrt.scene.background import Background
    from glrt.scene.camera import Camera
    from glrt.scene.clear_sky import ClearSky
    from glrt.scene.cone import Cone
    from glrt.scene.cylinder import Cylinder
    from glrt.scene.materials import Dielectric, Lambertian, Light, Metal, Principled
    from glrt.scene.meshes import Mesh
    from glrt.scene.scene import Scene
    from glrt.scene.shapes import Disk, Plane, Quad, Sphere
    from glrt.scene.solids import Box
    from glrt.scene.sun import Sun
    from glrt.scene.textures import NormalTexture, Texture
    from glrt.settings import Settings

__all__ = [
    "Background",
    "Box",
    "Camera",
    "ClearSky",
    "Comparison",
    "Cone",
    "Contribution",
    "Cylinder",
    "Dielectric",
    "Disk",
    "Image",
    "Lambertian",
    "Light",
    "Mesh",
    "Metal",
    "NormalTexture",
    "Path",
    "PathVertex",
    "PixelPaths",
    "Plane",
    "Principled",
    "Quad",
    "Renderer",
    "Scene",
    "Settings",
    "Sphere",
    "Sun",
    "Texture",
    "__version__",
    "compare",
    "load",
    "merge",
    "paths",
    "render",
]

__version__ = VERSION

_HOMES = {
    "Background": "scene.background",
    "ClearSky": "scene.clear_sky",
    "Sun": "scene.sun",
    "Box": "scene.solids",
    "Camera": "scene.camera",
    "Comparison": "comparison.result",
    "Cone": "scene.cone",
    "Contribution": "rendering.path_values",
    "Cylinder": "scene.cylinder",
    "Dielectric": "scene.materials",
    "Disk": "scene.shapes",
    "Image": "image.image",
    "Lambertian": "scene.materials",
    "Light": "scene.materials",
    "Mesh": "scene.meshes",
    "Metal": "scene.materials",
    "NormalTexture": "scene.textures",
    "Path": "rendering.path_values",
    "PathVertex": "rendering.path_values",
    "PixelPaths": "rendering.path_values",
    "Principled": "scene.materials",
    "Plane": "scene.shapes",
    "Quad": "scene.shapes",
    "Renderer": "rendering.renderer",
    "Scene": "scene.scene",
    "Settings": "settings",
    "Sphere": "scene.shapes",
    "Texture": "scene.textures",
    "compare": "comparison.verdict",
    "load": "image.sources",
    "merge": "image.merge",
    "paths": "api",
    "render": "api",
}


def __getattr__(name: str) -> "Any":
    """A public name, imported from where it is defined."""
    if name not in _HOMES:
        raise AttributeError(f"module 'glrt' has no attribute {name!r}")
    from importlib import import_module

    return getattr(import_module(f"glrt.{_HOMES[name]}"), name)


def __dir__() -> list[str]:
    return __all__
