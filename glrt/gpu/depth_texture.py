"""A depth buffer of floats, which moderngl does not offer: its own rounds depths to 24 bits."""

import ctypes

import moderngl

_TEXTURE_2D, _DEPTH, _FLOAT = 0x0DE1, 0x1902, 0x1406
_DEPTH32F = 0x8CAC  # GL_DEPTH_COMPONENT32F: of OpenGL 3.0
_TYPES = (ctypes.c_uint, *[ctypes.c_int] * 5, *[ctypes.c_uint] * 2, ctypes.c_void_p)


def depth_texture(gl: moderngl.Context, size: tuple[int, int]) -> moderngl.Texture:
    """Return a depth texture of float32, of a size in pixels, without content."""
    texture = gl.depth_texture(size)
    address = gl.mglo._context.load_opengl_function("glTexImage2D")
    allocate = ctypes.CFUNCTYPE(None, *_TYPES)(address)
    texture.use(0)
    allocate(_TEXTURE_2D, 0, _DEPTH32F, *size, 0, _DEPTH, _FLOAT, None)
    return texture
