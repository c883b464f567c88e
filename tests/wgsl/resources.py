"""Buffers and textures on the device, under the thesis's names."""

from typing import Any

import numpy as np

from glrt.scene.scene import Scene
from glrt.settings import Settings
from tests.wgsl import packing
from tests.wgsl.device import Device
from tests.wgsl.seeds import seed_texture

_UNIFORM, _STORAGE, _COPY_DST, _COPY_SRC = 0x40, 0x80, 0x08, 0x04  # of wgpu.BufferUsage
_SAMPLED, _STORED, _TARGET, _TO, _FROM = 0x04, 0x08, 0x10, 0x02, 0x01  # of wgpu.TextureUsage


class SceneBuffers:
    """Camera, objects, materials, settings and sample counter."""

    def __init__(self, device: Device, scene: Scene, settings: Settings) -> None:
        """Fill them; the counter starts at 0."""
        self._device = device
        self.counter = self._filled(bytes(4), _UNIFORM)
        self.in_order = [
            self._filled(packing.camera_buffer(scene, settings), _UNIFORM),
            self._filled(packing.object_buffer(scene), _STORAGE),
            self._filled(packing.material_buffer(scene), _STORAGE),
            self._filled(packing.settings_buffer(scene, settings), _UNIFORM),
            self.counter,
        ]

    def count(self, samples: int) -> None:
        """Write the sample counter."""
        self._device.queue.write_buffer(self.counter, 0, samples.to_bytes(4, "little"))

    def wait(self) -> None:
        """Until the device has done all that it was given."""
        self._device.queue.read_buffer(self.counter)

    def _filled(self, data: bytes, usage: int) -> Any:
        usage |= _COPY_DST | _COPY_SRC
        return self._device.create_buffer_with_data(data=data, usage=usage)


class RandomTexture:
    """A 32-bit seed for each pixel."""

    def __init__(self, device: Device, settings: Settings) -> None:
        """Holds the seeds of the first sample."""
        self._device = device
        self._seed = settings.seed
        self._size = (settings.width, settings.height, 1)
        self.texture = texture(device, self._size, "r32uint", _SAMPLED | _TO)
        self.refresh(0)

    def refresh(self, sample: int) -> None:
        """Other seeds, for this sample."""
        width, height, _ = self._size
        self.write(seed_texture(width, height, sample, self._seed))

    def write(self, seeds: np.ndarray[Any, Any]) -> None:
        """These seeds, (H, W) uint32."""
        width, height, _ = self._size
        rows = {"bytes_per_row": 4 * width, "rows_per_image": height}
        self._device.queue.write_texture({"texture": self.texture}, seeds, rows, self._size)


def color_texture(device: Device, size: tuple[int, int], texel: str) -> Any:
    """A texture that can be source and target."""
    return texture(device, (*size, 1), texel, _SAMPLED | _STORED | _FROM)


def screen_texture(device: Device, size: tuple[int, int, int], texel: str) -> Any:
    """A texture to draw on."""
    return texture(device, size, texel, _TARGET | _FROM)


def texture(device: Device, size: tuple[int, int, int], texel: str, usage: int) -> Any:
    """A texture of one layer."""
    return device.create_texture(size=size, format=texel, usage=usage)


def look_buffer(device: Device, content: bytes) -> Any:
    """How the picture is to be shown."""
    return device.create_buffer_with_data(data=content, usage=_UNIFORM)


def output_buffer(device: Device, size: int) -> Any:
    """A buffer that a shader fills, of zeros."""
    return device.create_buffer(size=size, usage=_STORAGE | _COPY_SRC)


def read_texture(device: Device, source: Any, bytes_per_texel: int) -> bytes:
    """The content of a texture, row after row."""
    width, height, _ = source.size
    rows = {"bytes_per_row": bytes_per_texel * width, "rows_per_image": height}
    return bytes(device.queue.read_texture({"texture": source}, rows, source.size))
