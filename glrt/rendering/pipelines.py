"""The two ways to run the path tracer: a compute shader, or a fragment shader for OpenGL 4.1."""

from collections.abc import Mapping, Sequence
from typing import Literal, NamedTuple, get_args

import moderngl

from glrt.core.errors import ContextError
from glrt.gpu import struct_arrays
from glrt.gpu.context import Context, Pipeline
from glrt.gpu.glsl import Source
from glrt.gpu.program import FragmentKernel, Kernel, Resource
from glrt.gpu.struct_arrays import (
    READ,
    Arrays,
    Layout,
    read_content,
    scene_arrays,
    uniform_bytes,
)
from glrt.packing.shapes import NUMBERED, PLACES
from glrt.packing.texel_texture import BITS, WIDTH
from glrt.plan.facts import MOST_BAKED, MOST_NEAR
from glrt.rendering.passes import RADIANCE, RenderPass, Resolved

# "baked" writes the shapes into the kernel's text, so that each edit of them compiles, and each
# motion of the camera; "placed" writes all of them but their places, which it reads; "generic"
# reads the shapes. "complete" writes lamps, too: each edit of a light compiles. Materials are never
# written: it takes no less time, and a colour is to change without compiling.
Tier = Literal["generic", "placed", "baked", "complete"]
Fast = Literal["placed", "baked"]
TIERS: tuple[Tier, ...] = get_args(Tier)  # the fastest last
ENVIRONMENT = "environment_image"  # the texture of the image of the sky
SKY_TREE = "environment_tree"  # the texture of the tree that samples this image
RESERVOIRS = "held_reservoirs"  # the texture of what samples keep for later ones
TEXELS = "map_texels"  # the texture of all images on surfaces
VOXELS = "grid_voxels"  # the texture of all grids of media
FEW = 32  # shapes of a scene: each row that is looked up is a constant
FEW_OF_KIND = 8  # the same in a scene of more shapes
SHAPES = (*NUMBERED, "Target", "Sides")  # arrays that follow from the shapes alone
LAMPS = ("Light", "Cluster", "Aim")


class Variant(NamedTuple):
    """Changes to glrt's kernel, for experiments: replaced constants and whole shader files."""

    constants: Mapping[str, bool | int] = {}
    texts: Mapping[str, str] = {}  # by the name of the shader file


PLAIN = Variant()


class KernelOptions(NamedTuple):
    """Pipeline, tier and variant of the kernels of a scene."""

    pipeline: Resolved
    tier: Tier
    variant: Variant = PLAIN


def resolve(wanted: Pipeline, context: Context) -> Resolved:
    """The pipeline for a context: compute where possible; ContextError if it cannot be had."""
    if wanted == "compute" and not context.has_compute:
        raise ContextError(
            f"{context.renderer} has no compute shaders: they need OpenGL 4.3, and it offers "
            f"{context.version}. Leave the pipeline to `auto`."
        )
    if wanted == "auto":
        return "compute" if context.has_compute else "fragment"
    return wanted


def tier_for(arrays: Arrays, wanted: Tier) -> Tier:
    """The tier that a scene gets: "generic" if it has more than MOST_BAKED shapes."""
    return wanted if _can_bake(arrays) else "generic"


def _can_bake(arrays: Arrays) -> bool:
    return _shapes(arrays) <= MOST_BAKED


def _shapes(arrays: Arrays) -> int:
    return sum(len(arrays[struct]) for struct in NUMBERED)


def scene_text(gl: moderngl.Context, arrays: Arrays, tier: Tier) -> str:
    """The generated shader file that declares the arrays of a scene."""
    return text_of(arrays, tier, uniform_bytes(gl))


def text_of(arrays: Arrays, tier: Tier, most_bytes: int) -> str:
    """Like `scene_text`, for a driver whose uniform blocks hold `most_bytes` bytes."""
    return scene_arrays(arrays, NUMBERED, _layout(arrays, tier), most_bytes) + _SKY


_SKY = f"""
uniform sampler2D {ENVIRONMENT};
ivec2 environment_size() {{ return textureSize({ENVIRONMENT}, 0); }}
vec3 environment_pixel(int column, int row) {{
    return texelFetch({ENVIRONMENT}, ivec2(column, row), 0).rgb;
}}
uniform sampler2D {SKY_TREE};
vec4 sky_part(int column, int row) {{ return texelFetch({SKY_TREE}, ivec2(column, row), 0); }}
uniform sampler2D probe_light;
vec4 probe_light_at(ivec2 texel) {{ return texelFetch(probe_light, texel, 0); }}
uniform sampler2D probe_distances;
vec4 probe_distances_at(ivec2 texel) {{ return texelFetch(probe_distances, texel, 0); }}
uniform sampler2D probe_places;
vec4 probe_place_at(ivec2 texel) {{ return texelFetch(probe_places, texel, 0); }}
uniform sampler2D {RESERVOIRS};
vec4 reservoir_part_at(ivec2 texel) {{ return texelFetch({RESERVOIRS}, texel, 0); }}
uniform sampler2D {TEXELS};
vec4 texel_at(int index) {{
    return texelFetch({TEXELS}, ivec2(index & {WIDTH - 1}, index >> {BITS}), 0);
}}
uniform sampler2D {VOXELS};
vec4 voxel_at(int index) {{
    return texelFetch({VOXELS}, ivec2(index & {WIDTH - 1}, index >> {BITS}), 0);
}}
"""


def upload(gl: moderngl.Context, arrays: Arrays, tier: Tier) -> dict[str, Resource]:
    """Upload the arrays as the generated file declares them, by block and texture name."""
    return dict(struct_arrays.upload(gl, arrays, _layout(arrays, tier), uniform_bytes(gl)))


def _layout(arrays: Arrays, tier: Tier) -> Layout:
    if tier == "generic":
        return Layout()
    if tier == "placed":
        return Layout(NUMBERED, PLACES, _looked_up(arrays))
    is_lit = tier == "complete" and max(len(arrays[struct]) for struct in LAMPS) <= MOST_NEAR
    return Layout((*SHAPES, *(LAMPS if is_lit else ())), looked_up=_looked_up(arrays))


def _looked_up(arrays: Arrays) -> list[str]:
    """Structs whose rows are read where any of them may be asked for.

    To choose among many constants takes long to compile, and to read few rows takes long to run.
    """
    if _shapes(arrays) <= FEW:
        return []
    return [struct for struct in NUMBERED if len(arrays[struct]) > FEW_OF_KIND]


def places(gl: moderngl.Context, arrays: Arrays) -> dict[str, Resource]:
    """Upload the places of shapes as the tier "placed" reads them, if they may be written."""
    return {READ: gl.buffer(read_content(arrays, PLACES))} if _can_bake(arrays) else {}


def sources(
    pipeline: Resolved,
    constants: Mapping[str, bool | int],
    texts: Mapping[str, str],
    render_pass: RenderPass = RADIANCE,
) -> list[Source]:
    """The shaders of a pass for a scene; `texts` replace shader files, by name."""
    version = "430 core" if pipeline == "compute" else "410 core"
    prelude = {**constants, **render_pass.constants}
    if render_pass != RADIANCE:  # others trace their camera rays: the same surfaces, to the bit
        prelude["RASTERS"] = False
    return [Source(file, prelude, version, texts) for file in render_pass.shaders[pipeline]]


def compiled(gl: moderngl.Context, shaders: Sequence[Source]) -> Kernel | FragmentKernel:
    """Compile a kernel; RenderError gives the driver's message by shader file and line."""
    return Kernel(gl, *shaders) if len(shaders) == 1 else FragmentKernel(gl, *shaders)
