"""A WebGPU device, of whatever adapter there is."""

from functools import cache
from typing import Any

from glrt.core.errors import ContextError

Device = Any  # wgpu is imported where it is used: it is no dependency of glrt


def open_device() -> Device:
    """The device of the best adapter; ContextError if there is none."""
    try:
        adapter = _webgpu().request_adapter_sync(power_preference="high-performance")
    except ImportError:
        raise ContextError("no WebGPU: install the Python package wgpu") from None
    except RuntimeError:
        raise ContextError(
            "no WebGPU adapter. On Debian or Ubuntu install libvulkan1 and mesa-vulkan-drivers "
            "(software Vulkan), or the Vulkan driver of your GPU"
        ) from None
    return adapter.request_device_sync()


def describe(device: Device) -> str:
    """The adapter's name, such as "llvmpipe (LLVM 15.0.6, 256 bits) via Vulkan"."""
    info = device.adapter.info
    return f"{info['device']} via {info['backend_type']}"


def is_software(device: Device) -> bool:
    """Whether the processor computes."""
    return bool(device.adapter.info["adapter_type"] == "CPU")


@cache
def _webgpu() -> Any:
    """wgpu's entry, on Vulkan, Metal or Direct3D 12.

    On OpenGL it would compare that with itself, and take over the context that is current.
    """
    import wgpu  # type: ignore[import-untyped]
    from wgpu.backends.wgpu_native.extras import set_instance_extras  # type: ignore[import-untyped]

    set_instance_extras(backends=["Primary"])
    return wgpu.gpu
