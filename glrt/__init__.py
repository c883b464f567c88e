"""glrt: a physically based path tracer in OpenGL compute shaders."""

from typing import Any

from glrt.garbage import leave_imports_alone
from glrt.signals import leave_at_once_while_loading

leave_at_once_while_loading()
leave_imports_alone()

from glrt.compare import compare
from glrt.comparison import Comparison
from glrt.image import Image
from glrt.library import load
from glrt.renderer import Renderer
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


def render(scene: Scene, samples: int = 64, **settings: Any) -> Image:
    """Render a scene; `settings` are fields of Settings, and `context`."""
    renderer = Renderer(scene, tier="baked", samples=samples, **settings)
    try:
        return renderer.render().image()
    finally:
        renderer.release()
