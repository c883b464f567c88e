"""A compute shader over the pixels of a frame, and the groups in which it finds its resources."""

from collections.abc import Sequence
from typing import Any

from tests.wgsl.device import Device
from tests.wgsl.text import RAYTRACER, Fault, joined

GROUP = 8  # work group of 8 x 8
_COMPUTE = 4  # of wgpu.ShaderStage
_UNIFORM, _STORAGE = ({"buffer": {"type": kind}} for kind in ("uniform", "read-only-storage"))
_SCENE = (_UNIFORM, _STORAGE, _STORAGE, _UNIFORM, _UNIFORM)  # resources.SceneBuffers
SEEDS = {"texture": {"sample_type": "uint"}}
COLOR = {"texture": {"sample_type": "unfilterable-float"}}
OUTPUT = {"buffer": {"type": "storage"}}

Layout = Sequence[dict[str, Any]]


class Program:
    """Compiled: group 0 holds the scene, group 1 what this shader alone has."""

    def __init__(self, device: Device, source: str, own: Layout) -> None:
        """`own` are the kinds of resources in group 1, in the order of their slots."""
        self.device = device
        self._layouts = [self._layout(kinds) for kinds in (_SCENE, own)]
        self._pipeline = device.create_compute_pipeline(
            layout=device.create_pipeline_layout(bind_group_layouts=self._layouts),
            compute={"module": device.create_shader_module(code=source), "entry_point": "main"},
        )

    def bind(self, group: int, resources: Sequence[Any]) -> Any:
        """Buffers and textures in the order of their slots."""
        entries = [{"binding": slot, "resource": each} for slot, each in enumerate(resources)]
        return self.device.create_bind_group(layout=self._layouts[group], entries=entries)

    def run(self, groups: Sequence[Any], width: int, height: int) -> None:
        """One invocation a pixel."""
        encoder = self.device.create_command_encoder()
        compute = encoder.begin_compute_pass()
        compute.set_pipeline(self._pipeline)
        for number, group in enumerate(groups):
            compute.set_bind_group(number, group)
        compute.dispatch_workgroups(-(-width // GROUP), -(-height // GROUP))
        compute.end()
        self.device.queue.submit([encoder.finish()])

    def _layout(self, kinds: Layout) -> Any:
        entries = [
            {"binding": slot, "visibility": _COMPUTE, **kind} for slot, kind in enumerate(kinds)
        ]
        return self.device.create_bind_group_layout(entries=entries)


class RayTracer(Program):
    """The thesis's compute shader: random texture, two sources, two targets."""

    def __init__(self, device: Device, *faults: Fault, texel: str = "rgba32float") -> None:
        """Compile `raytracer.wgsl`; `texel` is the format of the colour textures."""
        source = joined(RAYTRACER, *faults).replace("rgba32float", texel)
        target = {"storage_texture": {"access": "write-only", "format": texel}}
        super().__init__(device, source, [SEEDS, COLOR, COLOR, target, target])
        self.texel = texel
