"""Arrays of structs, and how a kernel reads each: constants, a uniform block, or a texture.

The GLSL for the arrays of one scene stands in place of the include `scene_arrays.glsl`; it is the
only shader text that is not a file. Constants are fastest, and each change of them compiles a
kernel. Uniform blocks are limited in size; larger arrays lie in textures. Figures:
docs/results/speed.md.

Textures hold unsigned integers, since a texture of floats may lose numbers that look denormal.
Texels are read at their middle, by coordinates from 0 to 1, and not by number: for numbers,
llvmpipe looks up the size of a level lane by lane, which takes longer than the read.
"""

from collections.abc import Collection, Mapping, Sequence
from itertools import accumulate, pairwise
from typing import Any, NamedTuple

import moderngl
import numpy as np

from glrt.gpu.constant_arrays import (
    LOOP,
    Reads,
    constants,
    count_of,
    getter_of,
    nothing,
    one_loop,
    two_loops,
)

Array = np.ndarray[Any, Any]
Arrays = Mapping[str, Array]  # rows, by the name of their struct

FILE = "scene_arrays.glsl"
MOST_UNIFORM_BYTES = 65_536  # llvmpipe's limit; quads are 1.05 times as fast as in a texture
LEAST_ROWS = 32
READ = "ReadRows"  # the block of the fields of constant structs that are read
MOST_READ = 64  # its rows
MOST_DOUBLED = 64  # rows of a texture that grows to powers of two; beyond, in smaller steps

_BITS = 9
ROWS = 1 << _BITS  # structs along a texture: of 7 texels each, within the 16,384 that OpenGL grants
_TEXEL = 16  # bytes of an RGBA32UI texel
_CASTS = {"f": "uintBitsToFloat({})", "i": "int({})", "u": "{}"}


def block_of(struct: str) -> str:
    """Return the name of the uniform block or texture that holds the rows of a struct."""
    return f"{struct}Rows"


class Layout(NamedTuple):
    """Which arrays a kernel has as constants, and what it reads nonetheless."""

    constant: Collection[str] = ()  # structs
    read: Mapping[str, str] = {}  # a vec3 of constant structs
    looked_up: Collection[str] = ()  # constant structs whose rows are constants in loops alone

    def is_read(self, struct: str) -> bool:
        """Whether a kernel reads the rows of a struct from a block or texture."""
        return struct not in self.constant or struct in self.looked_up


def scene_arrays(
    arrays: Arrays, numbered: Sequence[str], layout: Layout, uniform_bytes: int
) -> str:
    """Return GLSL that declares the arrays and the functions by which the kernel reads them.

    Each struct has `sphere_at(index)` and, if the struct Frame counts it, `sphere_count()`. Structs
    that are `numbered` share one numbering, in this order: `first_sphere()` is the number of the
    first, `is_sphere(number)` is true for this kind alone, and `up_to_sphere(number)` for this kind
    and earlier ones, if the number is that of a shape and not of a triangle. Loops over all their
    rows come in two: `sphere_of_first(index)` up to `sphere_first_count()`, and
    `sphere_of_second(index)`, which is row LOOP + index. Structs that are constant by the layout,
    or have no rows, are written into the text; fields that the layout reads come from the block
    READ. Uniform blocks have at most `uniform_bytes` bytes.
    """
    reads = _reads(arrays, layout)
    has_more = any(len(arrays[struct]) > LOOP for struct in layout.looked_up)
    parts = [
        "layout(std140) uniform FrameBlock { Frame frame; };",
        f"const bool SHAPES_ARE_CONSTANT = {_bool(layout.constant)};",
        f"const int LOOP = {LOOP};",
        f"const bool HAS_SECOND_LOOP = {_bool(has_more)};",
    ]
    if reads:
        parts.append(f"layout(std140) uniform {READ} {{ vec4 read_rows[{MOST_READ}]; }};")
    for struct, rows in arrays.items():
        name, is_constant = struct.lower(), struct in layout.constant
        if not len(rows):
            parts += [nothing(struct, rows, f"{name}_at"), count_of(name, "0")]
        elif layout.is_read(struct):
            in_block = is_uniform(struct, rows, uniform_bytes)
            parts.append(_uniform(struct, rows) if in_block else _texture(struct, rows))
        else:
            parts.append(constants(struct, rows, f"{name}_at", f"{name}_rows", reads.get(struct)))
        if len(rows) and (is_constant or struct in (*numbered, *COUNTED)):
            parts.append(count_of(name, str(len(rows)) if is_constant else f"frame.{name}_count"))
        if struct in numbered:
            has_two = struct in layout.looked_up
            parts += two_loops(struct, rows, reads.get(struct)) if has_two else one_loop(struct)
    return "\n".join([*parts, *_numbering(arrays, numbered)]) + "\n"


# Never in a uniform block: OpenGL 4.1 grants a kernel 12, which the other structs take.
TEXTURED = (
    *("Mesh", "Corner", "Triangle", "Instance", "Tint"),
    *("Conductor", "Glass", "Gloss", "Albedo", "Emitter", "Aim", "Target", "Sides"),
    *("Map", "Maps", "Axes", "Uv", "Tangent", "Medium", "Boundary"),
)
COUNTED = ("Node", "Slot", "Light")  # by the struct Frame, in addition to the numbered structs


def read_content(arrays: Arrays, read: Mapping[str, str]) -> bytes:
    """Return the content of the block READ; kernels have MOST_READ rows of it at most."""
    values = np.concatenate([arrays[struct][field] for struct, field in read.items()])
    rows = np.zeros((max(len(values), MOST_READ), 4), np.float32)
    rows[: len(values), :3] = values
    return rows.tobytes()


def upload(
    gl: moderngl.Context, arrays: Arrays, layout: Layout, uniform_bytes: int
) -> dict[str, moderngl.Buffer | moderngl.Texture]:
    """Return buffers and textures of the arrays as `scene_arrays` declares them, by name.

    The block READ is not among them.
    """
    return {
        block_of(struct): gl.buffer(uniform_content(rows))
        if is_uniform(struct, rows, uniform_bytes)
        else texture_of(gl, rows)
        for struct, rows in arrays.items()
        if layout.is_read(struct) and len(rows)
    }


def uniform_bytes(gl: moderngl.Context) -> int:
    """Return how many bytes a uniform block may have."""
    return min(MOST_UNIFORM_BYTES, int(gl.info["GL_MAX_UNIFORM_BLOCK_SIZE"]))


def is_uniform(struct: str, rows: Array, uniform_bytes: int) -> bool:
    """Return whether an array that is not constant lies in a uniform block."""
    return struct not in TEXTURED and _capacity(rows) * rows.itemsize <= uniform_bytes


def uniform_content(rows: Array) -> bytes:
    """Return the content of a uniform block, as large as the block is declared."""
    return rows.tobytes().ljust(_capacity(rows) * rows.itemsize, b"\0")


def texture_of(gl: moderngl.Context, rows: Array) -> moderngl.Texture:
    """Return the texture of an array."""
    size = ROWS * rows.itemsize // _TEXEL, _height(len(rows))
    texture = gl.texture(size, 4, dtype="u4")
    texture.filter = moderngl.NEAREST, moderngl.NEAREST  # integers are not interpolated
    write_rows(texture, rows, len(rows))
    return texture


def write_rows(texture: moderngl.Texture, rows: Array, count: int) -> None:
    """Write the first `count` rows of an array, or some more, into its texture.

    Only the last line is copied before: there may be a hundred million bytes.
    """
    whole, rest = divmod(count, ROWS)
    width = ROWS * rows.itemsize // _TEXEL
    lines = np.ascontiguousarray(rows[: whole * ROWS])
    if whole:
        texture.write(lines.view(np.uint8).data, viewport=(0, 0, width, whole))
    if rest:
        last = rows[whole * ROWS : (whole + 1) * ROWS].tobytes().ljust(ROWS * rows.itemsize, b"\0")
        texture.write(last, viewport=(0, whole, width, 1))


def _numbering(arrays: Arrays, numbered: Sequence[str]) -> list[str]:
    first = "int first_{}() {{ return {}; }}".format
    counts = [f"{struct.lower()}_count()" for struct in numbered]
    lines = [
        first(struct.lower(), " + ".join(counts[:place]) or "0")
        for place, struct in enumerate(numbered)
    ]
    last = [struct for struct in numbered if len(arrays[struct])][-1:]
    for struct, after in pairwise([*numbered, ""]):
        limit = f"number < first_{after.lower()}()" if after and struct not in last else "true"
        lines.append(f"bool up_to_{struct.lower()}(int number) {{ return {limit}; }}")
    for name in map(str.lower, numbered):
        limits = f"number >= first_{name}() && number < first_{name}() + {name}_count()"
        lines.append(f"bool is_{name}(int number) {{ return {limits}; }}")
    return lines


def _bool(value: object) -> str:
    return "true" if value else "false"


def _reads(arrays: Arrays, layout: Layout) -> dict[str, Reads]:
    """Return what each struct with rows reads from the block READ."""
    lengths = [len(arrays[struct]) for struct in layout.read]
    starts = accumulate(lengths, initial=0)
    fields = layout.read.items()
    rows = zip(fields, starts, lengths, strict=False)
    return {struct: Reads(field, first) for (struct, field), first, length in rows if length}


def _uniform(struct: str, rows: Array) -> str:
    name = struct.lower()
    array = f"{struct} {name}_rows[{_capacity(rows)}];"
    block = f"layout(std140) uniform {block_of(struct)} {{ {array} }};"
    return f"{block}\n{getter_of(struct, f'{name}_at', f'{name}_rows')}"


def _texture(struct: str, rows: Array) -> str:
    """Return the GLSL of an array in a texture.

    A change of the row count changes the text only where it changes the height of the texture.
    """
    texels_each = rows.itemsize // _TEXEL
    block = block_of(struct)
    fetches = [
        f"    uvec4 row{k} = textureLod({block}, (place + vec2({k}.5, 0.5)) * texel, 0.0);"
        for k in range(texels_each)
    ]
    fields = [_field(field[0], field[1]) for field in (rows.dtype.fields or {}).values()]
    width, height = ROWS * texels_each, _height(len(rows))
    return "\n".join(
        [
            f"uniform usampler2D {block};",
            f"{struct} {struct.lower()}_at(int index) {{",
            f"    vec2 texel = vec2(1.0 / {width}.0, 1.0 / {height}.0);",
            f"    ivec2 row = ivec2({texels_each} * (index & {ROWS - 1}), index >> {_BITS});",
            "    vec2 place = vec2(row);",
            *fetches,
            f"    return {struct}({', '.join(fields)});",
            "}",
        ]
    )


def _capacity(rows: Array) -> int:
    """Return the rows of a uniform block; some are spare, so that a new shape seldom compiles.

    Blocks as large as allowed cost too much: with 64 KiB llvmpipe compiled for 4.5 s, not 0.6 s.
    """
    return max(LEAST_ROWS, 1 << (len(rows) - 1).bit_length())


def _height(count: int) -> int:
    """Return the height of the texture for so many structs, in rows.

    It is a power of two up to MOST_DOUBLED, then a multiple of an eighth of one.
    """
    rows = -(-count // ROWS)
    step = max(1 << max((rows - 1).bit_length() - 1, 0) >> 2, 1) if rows > MOST_DOUBLED else 0
    return -(-rows // step) * step if step else 1 << max(rows - 1, 0).bit_length()


def _field(dtype: np.dtype[Any], offset: int) -> str:
    base, count = dtype.base, dtype.itemsize // 4
    start = offset % _TEXEL // 4
    words = f"row{offset // _TEXEL}.{'xyzw'[start : start + count]}"
    if base.kind == "i" and count > 1:
        return f"ivec{count}({words})"
    return _CASTS[base.kind].format(words)
