"""Find what works on this machine by loading it: package databases do not know of drivers.

A probe returns "" when the thing works, else the reason why it does not. Probes that start a
driver run as `python probes.py egl|osmesa|vulkan` in a process of their own, which a driver may
crash.
"""

import ctypes
import importlib
import importlib.util
import shutil
import signal
import subprocess
import sys

PLATFORM_SURFACELESS = 0x31DD  # EGL_MESA_platform_surfaceless
PLATFORM_DEVICE = 0x313F  # EGL_EXT_platform_device
OSMESA_NAMES = ("libOSMesa.so.8", "libOSMesa.so.6")
# OSMesaCreateContextAttribs: OSMESA_FORMAT RGBA, OSMESA_PROFILE core, version 4.3, end
OSMESA_ATTRIBUTES = (0x22, 0x1908, 0x33, 0x34, 0x36, 4, 0x37, 3, 0)
VK_INSTANCE_CREATE_INFO = 1  # VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO
DRIVER_SECONDS = 60


def venv() -> str:
    """Can this Python make environments with pip in them? Debian keeps that in a package apart."""
    importlib.invalidate_caches()
    lacking = [name for name in ("venv", "ensurepip") if importlib.util.find_spec(name) is None]
    return f"this Python has no module {lacking[0]}" if lacking else ""


def library(*names: str) -> str:
    """Does one of these shared libraries load?"""
    reason = ""
    for name in names:
        try:
            ctypes.CDLL(name)
        except OSError as error:
            reason = reason or str(error)
        else:
            return ""
    return reason


def egl() -> str:
    """Does EGL start a display that needs no window system?"""
    return library("libGL.so.1") or library("libEGL.so.1") or _apart("egl")


def osmesa() -> str:
    """Does OSMesa, which draws into plain memory, make a context?"""
    return library(*OSMESA_NAMES) or _apart("osmesa")


def xvfb() -> str:
    """Is there an X server without a screen, for hidden windows?"""
    return library("libX11.so.6") if shutil.which("Xvfb") else "no program Xvfb"


def glslang() -> str:
    """Is the front end of the GLSL standard there? The tests run all shaders through it."""
    return "" if shutil.which("glslangValidator") else "no program glslangValidator"


def chromium() -> str:
    """Is a browser there? The tests open the pages that glrt writes."""
    names = ("chromium-headless-shell", "chromium", "google-chrome")
    return "" if any(map(shutil.which, names)) else f"no program {names[0]}"


def window() -> str:
    """Are the libraries there with which a window opens under X11?"""
    return library("libGL.so.1") or library("libX11.so.6") or library("libXext.so.6")


def vulkan() -> str:
    """Does Vulkan find a device? The tests run a WGSL version of the path tracer on it."""
    return library("libvulkan.so.1") or _apart("vulkan")


def llvm() -> str:
    """Is the version of LLVM there that Mitsuba works with (15 and 16 crash it), and libatomic?"""
    return library("libLLVM.so.19.1") or library("libatomic.so.1")


def cxx() -> str:
    """Is the C++ runtime there, which the compiled Python packages need?"""
    return library("libstdc++.so.6")


def _apart(driver: str) -> str:
    command = [sys.executable, __file__, driver]
    try:
        done = subprocess.run(
            command, stdin=subprocess.DEVNULL, capture_output=True, timeout=DRIVER_SECONDS
        )
    except subprocess.TimeoutExpired:
        return f"the driver gave no answer within {DRIVER_SECONDS} s"
    if done.returncode < 0:
        return f"the driver ended with {signal.Signals(-done.returncode).name}"
    said = done.stderr.decode(errors="replace").strip().splitlines()
    return "" if done.returncode == 0 else (said or ["no reason given"])[-1]


def start_egl() -> None:
    """Initialise the surfaceless display or the first device; exit with the reason if none does."""
    lib = ctypes.CDLL("libEGL.so.1")
    if not any(_initialises(lib, display) for display in _displays(lib)):
        sys.exit("EGL starts no display without a window: it finds no driver")


def _displays(lib: ctypes.CDLL) -> list[int | None]:
    display_of = lib.eglGetPlatformDisplay
    display_of.restype = ctypes.c_void_p
    display_of.argtypes = [ctypes.c_uint, ctypes.c_void_p, ctypes.c_void_p]
    surfaceless = display_of(PLATFORM_SURFACELESS, None, None)
    return [surfaceless, *(display_of(PLATFORM_DEVICE, device, None) for device in _devices(lib))]


def _devices(lib: ctypes.CDLL) -> list[int | None]:
    """The first EGL device, where the extension that lists devices is there."""
    lib.eglGetProcAddress.restype = ctypes.c_void_p
    address = lib.eglGetProcAddress(b"eglQueryDevicesEXT")
    if not address:
        return []
    integer, pointer = ctypes.c_int, ctypes.c_void_p
    query = ctypes.CFUNCTYPE(ctypes.c_uint, integer, pointer, pointer)(address)
    devices, count = (ctypes.c_void_p * 1)(), ctypes.c_int()
    query(1, devices, ctypes.byref(count))
    return list(devices)[: count.value]


def _initialises(lib: ctypes.CDLL, display: int | None) -> bool:
    lib.eglInitialize.argtypes = [ctypes.c_void_p] * 3
    return bool(display) and bool(lib.eglInitialize(display, None, None))


def start_osmesa() -> None:
    """Create an OpenGL 4.3 core context in memory; exit with the reason if that fails."""
    name = next(name for name in OSMESA_NAMES if not library(name))
    create = ctypes.CDLL(name).OSMesaCreateContextAttribs
    create.restype = ctypes.c_void_p
    create.argtypes = [ctypes.c_void_p, ctypes.c_void_p]
    if not create((ctypes.c_int * len(OSMESA_ATTRIBUTES))(*OSMESA_ATTRIBUTES), None):
        sys.exit("OSMesa makes no OpenGL 4.3 core context")


class _VkInstanceCreateInfo(ctypes.Structure):
    _fields_ = [
        ("type", ctypes.c_int),
        ("next", ctypes.c_void_p),
        ("flags", ctypes.c_uint),
        ("application", ctypes.c_void_p),
        ("layer_count", ctypes.c_uint),
        ("layers", ctypes.c_void_p),
        ("extension_count", ctypes.c_uint),
        ("extensions", ctypes.c_void_p),
    ]


def start_vulkan() -> None:
    """Create an instance of Vulkan 1.0; exit with the reason if it finds no device."""
    lib = ctypes.CDLL("libvulkan.so.1")
    instance, count = ctypes.c_void_p(), ctypes.c_uint()
    wishes = _VkInstanceCreateInfo(type=VK_INSTANCE_CREATE_INFO)
    if lib.vkCreateInstance(ctypes.byref(wishes), None, ctypes.byref(instance)):
        sys.exit("Vulkan finds no driver")
    lib.vkEnumeratePhysicalDevices(instance, ctypes.byref(count), None)
    if not count.value:
        sys.exit("Vulkan finds no device")


if __name__ == "__main__":
    {"egl": start_egl, "osmesa": start_osmesa, "vulkan": start_vulkan}[sys.argv[1]]()
