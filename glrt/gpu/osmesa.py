"""OSMesa: Mesa's software renderer without a window system, drawn into plain memory.

Mesa 25.1 removed it.
"""

import ctypes

from glrt.core.errors import ContextError

_LIBRARIES = ("libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so")
# In OSMesa's names: FORMAT = RGBA, DEPTH_BITS, PROFILE = CORE, CONTEXT_MAJOR_VERSION and _MINOR_.
_ATTRIBUTES = (0x22, 0x1908, 0x30, 24, 0x33, 0x34, 0x36, 4, 0x37)
_UNSIGNED_BYTE = 0x1401


class OSMesa:
    """An OSMesa context through ctypes, as a loader for moderngl."""

    def __init__(self, minor: int = 5) -> None:
        """Open a core context of OpenGL 4.`minor`; 4.5 is the newest that OSMesa has."""
        self._library = _load()
        create = self._library.OSMesaCreateContextAttribs
        create.restype, create.argtypes = ctypes.c_void_p, [ctypes.c_void_p, ctypes.c_void_p]
        attributes = (*_ATTRIBUTES, minor, 0)
        self._context = create((ctypes.c_int * len(attributes))(*attributes), None)
        if not self._context:
            raise ContextError(f"OSMesa has no OpenGL 4.{minor} core context")
        self._pixel = (ctypes.c_ubyte * 4)()  # the default framebuffer: unused, but required
        self.__enter__()

    def load_opengl_function(self, name: str) -> int:
        """Return the address of an OpenGL function, 0 if there is none."""
        find = self._library.OSMesaGetProcAddress
        find.restype, find.argtypes = ctypes.c_void_p, [ctypes.c_char_p]
        return find(name.encode()) or 0

    def __enter__(self) -> "OSMesa":
        """Make the context current."""
        bind = self._library.OSMesaMakeCurrent
        bind.restype = ctypes.c_ubyte
        bind.argtypes = [ctypes.c_void_p, ctypes.c_void_p, *[ctypes.c_int] * 3]
        if not bind(self._context, self._pixel, _UNSIGNED_BYTE, 1, 1):
            raise ContextError("OSMesaMakeCurrent failed")
        return self

    def __exit__(self, *_: object) -> None:
        """Stay current: OSMesa knows no previous context."""

    def release(self) -> None:
        """Destroy the context."""
        if self._context:
            destroy = self._library.OSMesaDestroyContext
            destroy.restype, destroy.argtypes = None, [ctypes.c_void_p]
            destroy(self._context)
            self._context = None


def _load() -> ctypes.CDLL:
    for name in _LIBRARIES:
        try:
            return ctypes.CDLL(name)
        except OSError:
            continue
    raise ContextError("no OSMesa library; Mesa 25.1 removed it")
