"""glrt: a physically based path tracer in OpenGL compute shaders."""

from glrt.image import Image
from glrt.library import load
from glrt.renderer import Renderer, render
from glrt.scene import Scene
from glrt.settings import Settings
from glrt.version import VERSION

__all__ = ["Image", "Renderer", "Scene", "Settings", "__version__", "load", "render"]

__version__ = VERSION
