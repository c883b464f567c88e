"""Stage by stage: what one sample of each pixel comes by, in both versions.

A difference between the pictures arose in the first stage that differs.
"""

from typing import Any

import numpy as np

from glrt.gpu.context import Context
from glrt.gpu.evaluate import path_files
from glrt.gpu.glsl import Source, read
from glrt.gpu.program import Kernel
from glrt.gpu.struct_arrays import FILE
from glrt.packing.scene_arrays import Dispatch, pack_frame
from glrt.plan.plan import prepare
from glrt.rendering.pipelines import scene_text, upload
from glrt.scene.scene import Scene
from glrt.settings import Settings
from tests.support.packed import packed
from tests.wgsl.device import Device
from tests.wgsl.program import OUTPUT, SEEDS, Program
from tests.wgsl.resources import RandomTexture, SceneBuffers, output_buffer
from tests.wgsl.text import FOLDER, PATH, Fault, joined, planted

Array = np.ndarray[Any, Any]

STAGE = np.dtype(
    [
        ("draws", [("digest", "u4"), ("count", "u4")]),
        ("ray", [("origin", "f4", 3), ("direction", "f4", 3)]),
        (
            "hit",
            [
                ("shape", "i4"),
                ("distance", "f4"),
                ("material", "i4"),
                ("position", "f4", 3),
                ("normal", "f4", 3),
            ],
        ),
        (
            "scattering",
            [
                ("depth", "i4"),
                ("inward", "u4"),
                ("direction", "f4", 3),
                ("throughput", "f4", 3),
                ("scale", "f4"),
                ("radiance", "f4", 3),
            ],
        ),
    ]
)

_WORDS = {f"{name.upper()}_WORD": field[1] // 4 for name, field in (STAGE.fields or {}).items()}
_CONSTANTS = {**_WORDS, "WORDS": STAGE.itemsize // 4}
_GROUP = 64  # work group of stages.comp
# Every number drawn goes through unit_float, in both languages.
_DRAWS = {"float": "float value = float(x >> 8u)", "f32": "return f32(x >> 8u)"}
_RECORD = "digest = pcg_hash(digest ^ x);\n    draws += 1u;\n    "


def glsl_stages(context: Context, scene: Scene, settings: Settings) -> Array:
    """The stages of the first sample by the kernel's path text: (H, W) of STAGE."""
    plan, arrays = prepare(scene, settings), packed(scene)
    counts = {struct: len(rows) for struct, rows in arrays.items()}
    recorder = "uint digest = 0u;\nuint draws = 0u;\n"
    recorded = _recording(read("sampling/unit_float.glsl"), "float")
    constants = {**plan.needs.constants(), **_CONSTANTS}
    with context.gl as gl:
        texts = {
            "stages": _glsl_entry(),
            FILE: scene_text(gl, arrays, "generic"),
            "sampling/unit_float.glsl": recorder + recorded,
        }
        kernel = Kernel(gl, Source("stages", constants, texts=texts))
        resources = upload(gl, arrays, "generic")
        frame = gl.buffer(pack_frame(plan, counts, Dispatch(0, 1), None))
        words = gl.buffer(reserve=STAGE.itemsize * settings.width * settings.height)
        kernel.bind({**resources, "FrameBlock": frame, "Words": words}, {})
        kernel.run_tiles(-(-settings.width * settings.height // _GROUP))
        content = words.read()
        for resource in (kernel, frame, words, *resources.values()):
            resource.release()
    return _shaped(content, settings)


class WgslStages:
    """The stages by the WGSL version, compiled once for all scenes."""

    def __init__(self, device: Device, *faults: Fault) -> None:
        """Compile the path text and `stages.wgsl`."""
        text = joined((*PATH, "stages"), *faults)
        constants = [f"const {name}: i32 = {value};" for name, value in _CONSTANTS.items()]
        recorded = ["var<private> digest: u32;", "var<private> draws: u32;"]
        source = "\n".join([*constants, *recorded, _recording(text, "f32")])
        self._program = Program(device, source, [SEEDS, OUTPUT])

    def run(self, scene: Scene, settings: Settings) -> Array:
        """The stages of the first sample: (H, W) of STAGE."""
        device, width, height = self._program.device, settings.width, settings.height
        words = output_buffer(device, STAGE.itemsize * width * height)
        seeds = RandomTexture(device, settings).texture.create_view()
        given = self._program.bind(0, SceneBuffers(device, scene, settings).in_order)
        self._program.run([given, self._program.bind(1, [seeds, words])], width, height)
        return _shaped(device.queue.read_buffer(words), settings)


def _glsl_entry() -> str:
    """The whole path text in front of `stages.comp`."""
    includes = [f'#include "{name}"' for name in path_files()]
    entry = (FOLDER / "stages.comp").read_text()
    return "\n".join([f"layout(local_size_x = {_GROUP}) in;", *includes, entry])


def _recording(source: str, to_float: str) -> str:
    return planted(source, _DRAWS[to_float], _RECORD + _DRAWS[to_float])


def _shaped(words: Any, settings: Settings) -> Array:
    return np.frombuffer(words, STAGE).reshape(settings.height, settings.width)
