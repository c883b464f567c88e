"""glrt: a physically based path tracer in OpenGL compute shaders.

Importing it loads nothing else: each public name is imported when it is first used.

Modules and packages, each importing only what stands above it:

- core: small tools that every other package uses
- process: signals, standard streams, time and memory of a command
- editable: the range and cost of an edit that fields of models declare
- phong: constants of Phong's model
- samplers: how each sampler divides the samples of a pixel
- settings: every render setting
- setting_options: these settings as keywords of functions
- gpu: OpenGL; knows no scene
- scene: frozen models of what is rendered, and scene files
- plan: which kernel a scene and its settings need
- accel: BVHs over shapes and triangles, clusters of lamps; arrays in, arrays out
- packing: a scene as arrays on the driver
- error: estimates of the error of a picture, and their reliability
- denoise: denoisers that estimate their own error
- image: pictures in files, with their recipe and the state of their film
- comparison: whether two pictures differ by more than their noise
- rendering: render a scene with settings: samples on a film
- series: series of pictures: animations, turntables and sweeps
- cluster: frames and pictures by the workers of a cluster
- doctor: which OpenGL routes work on a machine
- analysis: experiments with the renderer: chart, choice of a method
- lab: scenes on which methods fail, for `glrt stress`
- view: the window
- api: public functions that no other module defines
- notebook: live pictures in notebooks
- testing: a pytest plugin that compares pictures with references
- cli: the commands
- __main__: `python -m glrt`
"""

from glrt.core.version import VERSION

TYPE_CHECKING = False  # importing `typing` takes 5 ms, in which Ctrl-C would end in a traceback
if TYPE_CHECKING:
    from typing import Any

    from glrt.api import paths, render
    from glrt.comparison.result import Comparison
    from glrt.comparison.verdict import compare
    from glrt.core.errors import ContextError, GlrtError, RenderError, SceneError, UsageError
    from glrt.image.image import Image
    from glrt.image.merge import merge
    from glrt.image.sources import load
    from glrt.notebook.show import show
    from glrt.rendering.paths.values import Contribution, Path, PathVertex, PixelPaths
    from glrt.rendering.renderer import Renderer
    from glrt.scene.camera import Camera
    from glrt.scene.density import Density
    from glrt.scene.lights.background import Background
    from glrt.scene.lights.clear_sky import ClearSky
    from glrt.scene.lights.cone import Cone
    from glrt.scene.lights.sun import Sun
    from glrt.scene.materials.dielectric import Dielectric
    from glrt.scene.materials.lambertian import Lambertian
    from glrt.scene.materials.light import Light
    from glrt.scene.materials.metal import Metal
    from glrt.scene.materials.principled import Principled
    from glrt.scene.materials.textures import NormalTexture, Texture
    from glrt.scene.medium import Medium
    from glrt.scene.scene import Scene
    from glrt.scene.shapes.box import Box
    from glrt.scene.shapes.cylinder import Cylinder
    from glrt.scene.shapes.disk import Disk
    from glrt.scene.shapes.mesh import Mesh
    from glrt.scene.shapes.plane import Plane
    from glrt.scene.shapes.quad import Quad
    from glrt.scene.shapes.sphere import Sphere
    from glrt.scene.transfer import Transfer
    from glrt.settings import Settings

__all__ = [
    "Background",
    "Box",
    "Camera",
    "ClearSky",
    "Comparison",
    "Cone",
    "ContextError",
    "Contribution",
    "Cylinder",
    "Density",
    "Dielectric",
    "Disk",
    "GlrtError",
    "Image",
    "Lambertian",
    "Light",
    "Medium",
    "Mesh",
    "Metal",
    "NormalTexture",
    "Path",
    "PathVertex",
    "PixelPaths",
    "Plane",
    "Principled",
    "Quad",
    "RenderError",
    "Renderer",
    "Scene",
    "SceneError",
    "Settings",
    "Sphere",
    "Sun",
    "Texture",
    "Transfer",
    "UsageError",
    "__version__",
    "compare",
    "load",
    "merge",
    "paths",
    "render",
    "show",
]

__version__ = VERSION

_HOMES = {
    "Background": "scene.lights.background",
    "Box": "scene.shapes.box",
    "Camera": "scene.camera",
    "ClearSky": "scene.lights.clear_sky",
    "Comparison": "comparison.result",
    "Cone": "scene.lights.cone",
    "ContextError": "core.errors",
    "Contribution": "rendering.paths.values",
    "Cylinder": "scene.shapes.cylinder",
    "Density": "scene.density",
    "Dielectric": "scene.materials.dielectric",
    "Disk": "scene.shapes.disk",
    "GlrtError": "core.errors",
    "Image": "image.image",
    "Lambertian": "scene.materials.lambertian",
    "Light": "scene.materials.light",
    "Medium": "scene.medium",
    "Mesh": "scene.shapes.mesh",
    "Metal": "scene.materials.metal",
    "NormalTexture": "scene.materials.textures",
    "Path": "rendering.paths.values",
    "PathVertex": "rendering.paths.values",
    "PixelPaths": "rendering.paths.values",
    "Plane": "scene.shapes.plane",
    "Principled": "scene.materials.principled",
    "Quad": "scene.shapes.quad",
    "RenderError": "core.errors",
    "Renderer": "rendering.renderer",
    "Scene": "scene.scene",
    "SceneError": "core.errors",
    "Settings": "settings",
    "Sphere": "scene.shapes.sphere",
    "Sun": "scene.lights.sun",
    "Texture": "scene.materials.textures",
    "Transfer": "scene.transfer",
    "UsageError": "core.errors",
    "compare": "comparison.verdict",
    "load": "image.sources",
    "merge": "image.merge",
    "paths": "api",
    "render": "api",
    "show": "notebook.show",
}


def __getattr__(name: str) -> "Any":
    """Import and return a public name; AttributeError for any other name."""
    if name not in _HOMES:
        raise AttributeError(f"module 'glrt' has no attribute {name!r}")
    from importlib import import_module

    return getattr(import_module(f"glrt.{_HOMES[name]}"), name)


def __dir__() -> list[str]:
    return __all__
