"""The two ways to run the path text: a compute shader, or a fragment shader for OpenGL 4.1."""

from collections.abc import Mapping
from typing import Any, Literal

import moderngl
import numpy as np

from glrt.errors import ContextError
from glrt.gpu.context import Context, Pipeline
from glrt.gpu.glsl import Source
from glrt.gpu.program import FragmentKernel, Kernel, Resource
from glrt.gpu.struct_arrays import BAKED, Tier, blocks_text, is_uniform, padded
from glrt.gpu.texels import texels

Arrays = Mapping[str, np.ndarray[Any, Any]]
MOST_UNIFORM_BYTES = 65_536  # llvmpipe's limit: quads 1.05 times as fast as in a texture
Resolved = Literal["compute", "fragment"]


def resolve(wanted: Pipeline, context: Context) -> Resolved:
    """The pipeline for a context: compute where it can be. ContextError if it is wanted in vain."""
    if wanted == "compute" and not context.has_compute:
        raise ContextError(
            f"{context.renderer} has no compute shaders: they need OpenGL 4.3, and it offers "
            f"{context.version}. Leave the pipeline to `auto`."
        )
    if wanted == "auto":
        return "compute" if context.has_compute else "fragment"
    return wanted


def sources(
    pipeline: Resolved, constants: Mapping[str, bool | int], parts: Mapping[str, str]
) -> list[Source]:
    """The shaders of a kernel; `parts` are texts that stand in for shader files."""
    if pipeline == "compute":
        return [Source("trace.comp", constants, parts=parts)]
    entries = "trace.vert", "trace.frag"
    return [Source(entry, constants, "410 core", parts) for entry in entries]


def scene_text(gl: moderngl.Context, pipeline: Resolved, arrays: Arrays, tier: Tier) -> str:
    """How the kernel reads the arrays: in place of `blocks.glsl`."""
    return blocks_text(arrays, tier, pipeline == "compute", _uniform_bytes(gl))


def compiled(gl: moderngl.Context, shaders: list[Source]) -> Kernel | FragmentKernel:
    """The kernel; RenderError tells the driver's message by shader file and line."""
    return Kernel(gl, *shaders) if len(shaders) == 1 else FragmentKernel(gl, *shaders)


def upload(
    gl: moderngl.Context, pipeline: Resolved, arrays: Arrays, tier: Tier
) -> dict[str, Resource]:
    """The arrays as the kernel reads them: buffers, or textures where blocks are too small."""
    in_textures = pipeline == "fragment" or tier != "storage"
    return {
        name: texture_of(gl, rows)
        if in_textures and not is_uniform(rows, tier, _uniform_bytes(gl))
        else gl.buffer(padded(rows, tier, _uniform_bytes(gl)))
        for name, rows in arrays.items()
        if not (tier == "baked" and name in BAKED)
    }


def _uniform_bytes(gl: moderngl.Context) -> int:
    """How large a uniform block may be."""
    return min(MOST_UNIFORM_BYTES, int(gl.info["GL_MAX_UNIFORM_BLOCK_SIZE"]))


def texture_of(gl: moderngl.Context, rows: np.ndarray[Any, Any]) -> moderngl.Texture:
    """An array of structs as glrt.gpu.texels reads it."""
    size, content = texels(padded(rows, "storage"), rows.itemsize)
    texture = gl.texture(size, 4, content, dtype="u4")
    texture.filter = moderngl.NEAREST, moderngl.NEAREST  # integers are not interpolated
    return texture
