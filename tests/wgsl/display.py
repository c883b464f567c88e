"""The display pass: the picture as 8-bit colours."""

import struct
from typing import Any, get_args

import numpy as np

from glrt.settings import Settings, ToneMap
from tests.wgsl.device import Device
from tests.wgsl.resources import look_buffer, read_texture, screen_texture
from tests.wgsl.text import SHADER, Fault, joined

CODES = "rgba8unorm"


class DisplayPass:
    """The thesis's second shader, on a texture in place of a screen."""

    def __init__(self, device: Device, *faults: Fault) -> None:
        """Compile `shader.wgsl`."""
        self._device = device
        module = device.create_shader_module(code=joined(SHADER, *faults))
        self._pipeline = device.create_render_pipeline(
            layout="auto",
            vertex={"module": module, "entry_point": "at_corner"},
            primitive={"topology": "triangle-strip"},
            fragment={
                "module": module,
                "entry_point": "color_at",
                "targets": [{"format": CODES}],
            },
        )

    def codes(self, picture: Any, settings: Settings) -> np.ndarray[Any, Any]:
        """A texture of radiance as it is shown, (H, W, 3) uint8, row 0 on top."""
        screen = screen_texture(self._device, picture.size, CODES)
        self._draw(picture, settings, screen)
        data = read_texture(self._device, screen, 4)
        width, height, _ = picture.size
        return np.frombuffer(data, np.uint8).reshape(height, width, 4)[..., :3].copy()

    def _draw(self, picture: Any, settings: Settings, screen: Any) -> None:
        encoder = self._device.create_command_encoder()
        onto = {"view": screen.create_view(), "load_op": "clear", "store_op": "store"}
        draws = encoder.begin_render_pass(color_attachments=[onto])
        draws.set_pipeline(self._pipeline)
        draws.set_bind_group(0, self._bound(picture, settings))
        draws.draw(4)
        draws.end()
        self._device.queue.submit([encoder.finish()])

    def _bound(self, picture: Any, settings: Settings) -> Any:
        tonemap = get_args(ToneMap).index(settings.tonemap)
        look = look_buffer(self._device, struct.pack("<fi", settings.exposure, tonemap))
        entries = [
            {"binding": 0, "resource": look},
            {"binding": 1, "resource": picture.create_view()},
        ]
        layout = self._pipeline.get_bind_group_layout(0)
        return self._device.create_bind_group(layout=layout, entries=entries)
