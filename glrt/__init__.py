"""glrt: a physically based path tracer in OpenGL compute shaders."""

from glrt.compare import compare
from glrt.comparison import Comparison
from glrt.image import Image
from glrt.library import load
from glrt.renderer import Renderer, render
from glrt.scene import Scene
from glrt.settings import Settings
from glrt.version import VERSION

__all__ = [
    "Comparison",
    "Image",
    "Renderer",
    "Scene",
    "Settings",
    "__version__",
    "compare",
    "load",
    "render",
]

__version__ = VERSION
