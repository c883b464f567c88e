"""A WebGPU device, of whatever adapter there is."""

from typing import Any

from glrt.errors import ContextError

Device = Any  # wgpu is imported where it is used: it is no dependency of glrt


def open_device() -> Device:
    """The device of the best adapter; ContextError if there is none."""
    try:
        import wgpu  # type: ignore[import-untyped]
    except ImportError:
        raise ContextError("no WebGPU: install the Python package wgpu") from None
    try:
        adapter = wgpu.gpu.request_adapter_sync(power_preference="high-performance")
    except RuntimeError as error:
        raise ContextError(
            f"no WebGPU adapter ({error}). On Debian or Ubuntu install mesa-vulkan-drivers and "
            "libvulkan1 (software Vulkan), or the Vulkan driver of your GPU"
        ) from None
    return adapter.request_device_sync()


def describe(device: Device) -> str:
    """The adapter's name, such as "llvmpipe (LLVM 15.0.6, 256 bits) via Vulkan"."""
    info = device.adapter.info
    return f"{info['device']} via {info['backend_type']}"
