"""glrt: a physically based path tracer in OpenGL compute shaders."""

__version__ = "0.1.0"
