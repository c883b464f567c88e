"""The kernel that records what happens on paths, and the buffers for its records."""

from contextlib import ExitStack
from dataclasses import dataclass
from typing import Any, NamedTuple

import moderngl
import numpy as np

from glrt.core.errors import RenderError
from glrt.gpu.context import Context
from glrt.gpu.program import Images, Resource
from glrt.gpu.programs import AnyKernel
from glrt.plan.plan import Plan
from glrt.rendering.device_scene import DeviceScene
from glrt.rendering.kernel_switch import ready
from glrt.rendering.passes import RenderPass
from glrt.rendering.paths.records import RECORDS
from glrt.rendering.schedule import DispatchRange

Array = np.ndarray[Any, Any]
Pixel = tuple[int, int]  # column and row in the full frame, from 0, row 0 on top

GROUP = 32  # samples or particles of a work group, as paths.comp has it
TOGETHER = 512  # samples of a dispatch
HEAD = 32  # bytes of the block before its samples
FIRST_ROWS = 4096  # room for vertices and for lights, until more is needed
KINDS = {"Vertices": "VertexRecord", "Lights": "LightRecord"}  # blocks, with what they hold


class Batch(NamedTuple):
    """Records of one dispatch; vertices and lights come in any order."""

    samples: Array
    vertices: Array
    lights: Array


@dataclass
class _Numbered:
    """Stands in for a film in a dispatch: it has the number of the first sample."""

    next_sample: int
    samples: int = 0

    def images(self) -> Images:
        return {}


class PathRecorder:
    """Runs a pass of paths.comp over a plan's scene on the driver, and reads its records."""

    def __init__(
        self, context: Context, plan: Plan, scene: DeviceScene, render_pass: RenderPass
    ) -> None:
        """Compile the kernel; RenderError if the driver refuses it or has no room."""
        self._context, self._plan, self._scene = context, plan, scene
        self._buffers: dict[str, moderngl.Buffer] = {}
        with ExitStack() as refused:
            refused.callback(self._release_buffers)
            for name in KINDS:
                self._reserve(name, FIRST_ROWS)
            self._hold("Replay", HEAD + TOGETHER * RECORDS["SampleRecord"].itemsize)
            shaders = scene.shaders_of(render_pass)
            self._kernel: AnyKernel = ready(context, shaders, self._dispatch_none)
            refused.pop_all()

    def records(
        self,
        pixel: Pixel,
        first: int,
        samples: int,
        lanes: tuple[int, int] = (0, 0),
        vertices: bool = True,
        lights: bool = True,
    ) -> Batch:
        """Records of a pixel's samples, or of one sample's particles `lanes` (first and end).

        It takes one dispatch, or two if there are more records than room for them.
        """
        wanted = dict(zip(KINDS, (vertices, lights), strict=True))
        groups = -(-max(samples, lanes[1] - lanes[0]) // GROUP)
        while True:
            rows = [self._rows(name) if wanted[name] else 0 for name in KINDS]
            head = np.array([*pixel, 0, 0, *rows, *lanes], np.int32)
            self._buffers["Replay"].write(head.tobytes())
            self._dispatch(self._kernel, first, samples, groups)
            self._context.finish()
            counts = np.frombuffer(self._buffers["Replay"].read(HEAD), np.uint32)[2:4]
            if all(counts <= rows):
                break
            for name, needed in zip(KINDS, counts, strict=True):
                if needed > self._rows(name):
                    self._reserve(name, int(needed))
        read = (self._read(n, KINDS[n], int(c)) for n, c in zip(KINDS, counts, strict=True))
        return Batch(self._read("Replay", "SampleRecord", samples, HEAD), *read)

    def release(self) -> None:
        """Release all OpenGL resources."""
        self._context.programs.give_back(self._kernel)
        self._release_buffers()

    def _dispatch(self, kernel: AnyKernel, first: int, count: int, groups: int) -> None:
        part = DispatchRange(count, 0, groups)
        own: dict[str, Resource] = {**self._buffers}
        self._scene.dispatch(kernel, _Numbered(first), self._plan, part, 1, own)

    def _dispatch_none(self, kernel: AnyKernel, part: DispatchRange) -> None:
        self._buffers["Replay"].write(bytes(HEAD))
        self._dispatch(kernel, 0, part.samples, part.tiles)

    def _rows(self, name: str) -> int:
        return int(self._buffers[name].size) // RECORDS[KINDS[name]].itemsize

    def _reserve(self, name: str, rows: int) -> None:
        self._hold(name, rows * RECORDS[KINDS[name]].itemsize)

    def _hold(self, name: str, size: int) -> None:
        most = int(self._context.gl.info["GL_MAX_SHADER_STORAGE_BLOCK_SIZE"])
        if size > most:
            raise RenderError(
                f"no room for the records of paths: they take {size >> 20} MiB in one block, and "
                f"this driver grants {most >> 20}. Ask for fewer samples, or fewer bounces."
            )
        with self._context.checked("the records of paths"):
            buffer = self._context.gl.buffer(reserve=size)
        if name in self._buffers:
            self._buffers[name].release()
        self._buffers[name] = buffer

    def _read(self, name: str, record: str, rows: int, offset: int = 0) -> Array:
        dtype = RECORDS[record]
        if not rows:
            return np.zeros(0, dtype)
        return np.frombuffer(self._buffers[name].read(rows * dtype.itemsize, offset=offset), dtype)

    def _release_buffers(self) -> None:
        for buffer in self._buffers.values():
            buffer.release()
