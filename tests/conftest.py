"""Fixtures: one OpenGL context for the session, and shader functions run over arrays."""

import re
from collections.abc import Callable, Iterator
from typing import Any

import moderngl
import numpy as np
import pytest

from glrt.context import Context, open_context
from glrt.kernel import Kernel
from glrt.needs import needs_of
from glrt.pack import STRUCTS, pack_frame, pack_scene
from glrt.scene import Scene
from glrt.settings import settings_for
from glrt.shader import Source, read
from tests.builders import EVERYTHING

pytest_plugins = ["tests.slow_share"]

Array = np.ndarray[Any, Any]
CallGlsl = Callable[..., Array]

INCLUDES = re.findall(r'#include "(\w+\.glsl)"', read("trace.comp"))
_SCALARS = {"f": "float", "i": "int", "u": "uint"}
_CODES = {"float": "f4", "int": "i4", "uint": "u4", "bool": "u4"}


@pytest.fixture(scope="session")
def context() -> Iterator[Context]:
    """The context that `auto` chooses on this machine."""
    opened = open_context("auto")
    yield opened
    opened.gl.release()


@pytest.fixture
def ctx(context: Context) -> Iterator[moderngl.Context]:
    """The session's moderngl context, current, and free of GL errors before and after."""
    with context.gl:
        assert context.gl.error == "GL_NO_ERROR"
        yield context.gl
        assert context.gl.error == "GL_NO_ERROR"


@pytest.fixture
def call_glsl(ctx: moderngl.Context) -> CallGlsl:
    """`call_glsl("fresnel(c, eta)", c=array, eta=array)`: a shader expression over arrays.

    Inputs are arrays of n floats, ints or uints, or (n, 2..4) vectors, named as in the
    expression; `returns` is the GLSL type of the result ("float", "vec3", "uint", "bool").
    `setup` are statements that stand before the expression; `functions` go in front of main.
    All files of the path text are included, with every feature compiled in, or with those of
    `scene` and its blocks; `constants` override the prelude.
    """

    def call(
        expression: str,
        returns: str = "float",
        setup: str = "",
        functions: str = "",
        scene: Scene | None = None,
        constants: dict[str, bool | int] | None = None,
        **inputs: Any,
    ) -> Array:
        arrays = {name: _plain(values) for name, values in inputs.items()}
        count = max((len(values) for values in arrays.values()), default=1)
        prelude: dict[str, bool | int] = dict(EVERYTHING)
        if scene:
            prelude = needs_of(scene, settings_for(scene.render)).constants()
        text = _kernel(expression, returns, setup, functions, arrays)
        parts = {"call_glsl": text}
        source = Source("call_glsl", {**prelude, **(constants or {})}, parts=parts)
        kernel = Kernel(ctx, source)
        base, width = _base(returns)
        buffers = {f"In_{name}": ctx.buffer(values.tobytes()) for name, values in arrays.items()}
        buffers["Out"] = ctx.buffer(reserve=4 * width * count)
        buffers |= _scene_buffers(ctx, scene)
        kernel.bind(buffers, {})
        kernel.run(8 * (-(-count // 64)), 1)
        result = np.frombuffer(buffers["Out"].read(), _CODES[base]).reshape(count, width)
        kernel.release()
        for buffer in buffers.values():
            buffer.release()
        out: Array = result[:, 0] if width == 1 else result
        return out.astype(bool) if base == "bool" else out

    return call


def _plain(values: Any) -> Array:
    array = np.atleast_1d(np.asarray(values))
    if array.dtype.kind == "f":
        return array.astype(np.float32)
    return array.astype(np.uint32 if array.dtype.kind == "u" else np.int32)


def _base(glsl_type: str) -> tuple[str, int]:
    """The scalar type and the number of components: ("float", 3) of "vec3"."""
    if match := re.fullmatch(r"([iu]?)vec([234])", glsl_type):
        return {"": "float", "i": "int", "u": "uint"}[match[1]], int(match[2])
    return glsl_type, 1


def _kernel(
    expression: str, returns: str, setup: str, functions: str, arrays: dict[str, Array]
) -> str:
    base, width = _base(returns)
    stored = "uint" if base == "bool" else base
    blocks = [f"layout(std430) writeonly buffer Out {{ {stored} out_[]; }};"]
    locals_ = []
    for name, values in arrays.items():
        scalar = _SCALARS[values.dtype.kind]
        blocks.append(f"layout(std430) readonly buffer In_{name} {{ {scalar} in_{name}[]; }};")
        locals_.append(_local(name, values, scalar))
    parts = ["result_"] if width == 1 else [f"result_[{k}]" for k in range(width)]
    stores = [f"out_[{width} * i + {k}] = {stored}({part});" for k, part in enumerate(parts)]
    return "\n".join(
        [
            "layout(local_size_x = 64) in;",
            *(f'#include "{name}"' for name in INCLUDES),
            *blocks,
            functions,
            "void main() {",
            "    int i = int(gl_GlobalInvocationID.x);",
            f"    if (i >= out_.length() / {width}) return;",
            *locals_,
            setup,
            f"    {returns} result_ = {expression};",
            *stores,
            "}",
        ]
    )


def _local(name: str, values: Array, scalar: str) -> str:
    if values.ndim == 1:
        return f"    {scalar} {name} = in_{name}[{'i' if len(values) > 1 else '0'}];"
    width = values.shape[1]
    prefix = "" if scalar == "float" else scalar[0]
    parts = ", ".join(f"in_{name}[{width} * i + {k}]" for k in range(width))
    return f"    {prefix}vec{width} {name} = {prefix}vec{width}({parts});"


def _scene_buffers(gl: moderngl.Context, scene: Scene | None) -> dict[str, moderngl.Buffer]:
    """The kernel's blocks; of zeros without a scene, since blocks may be active unused."""
    if not scene:
        blocks = {"Spheres": "Sphere", "Planes": "Plane", "Quads": "Quad", "Lights": "Light"}
        blocks |= {"Materials": "Material", "FrameBlock": "Frame"}
        return {name: gl.buffer(bytes(STRUCTS[row].itemsize)) for name, row in blocks.items()}
    arrays = pack_scene(scene)
    counts = {name: len(rows) for name, rows in arrays.items()}
    frame = pack_frame(scene, settings_for(scene.render), counts, 0, 1)
    data = {name: rows.tobytes() or bytes(rows.itemsize) for name, rows in arrays.items()}
    return {name: gl.buffer(rows) for name, rows in {**data, "FrameBlock": frame}.items()}
