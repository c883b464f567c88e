"""Arrays of structs as textures of words, for what no uniform block holds.

The words are unsigned integers: a texture of floats may lose what looks like a denormal number.
Texels are read at their middle, between 0 and 1, and not by number: for numbers llvmpipe looks up
the size of a level lane by lane, which takes longer than reading (docs/speed.md).
"""

from typing import Any

import numpy as np

Array = np.ndarray[Any, Any]

_BITS = 9
ROWS = 1 << _BITS  # structs along a texture: with 7 texels each within the 16,384 that 4.1 grants
_TEXEL = 16  # bytes of RGBA32UI
_CASTS = {"f": "uintBitsToFloat({})", "i": "int({})", "u": "{}"}


def accessor(struct: str, block: str, rows: Array) -> str:
    """GLSL of a texture named `block` and of the function that reads a struct from it.

    Another count of `rows` is another text only where the texture is twice as high.
    """
    texels = rows.itemsize // _TEXEL
    fetches = [
        f"    uvec4 row{k} = textureLod({block}, (place + vec2({k}.5, 0.5)) * texel, 0.0);"
        for k in range(texels)
    ]
    fields = [_field(field[0], field[1]) for field in (rows.dtype.fields or {}).values()]
    return "\n".join(
        [
            f"uniform usampler2D {block};",
            f"{struct} {struct.lower()}_at(int index) {{",
            f"    vec2 texel = vec2(1.0 / {ROWS * texels}.0, 1.0 / {_height(len(rows))}.0);",
            f"    vec2 place = vec2({texels} * (index & {ROWS - 1}), index >> {_BITS});",
            *fetches,
            f"    return {struct}({', '.join(fields)});",
            "}",
        ]
    )


def texels(data: bytes, itemsize: int) -> tuple[tuple[int, int], bytes]:
    """Width and height of the texture for an array of structs, and its content."""
    width, height = ROWS * itemsize // _TEXEL, _height(len(data) // itemsize)
    return (width, height), data.ljust(width * height * _TEXEL, b"\0")


def _height(count: int) -> int:
    """Of the texture for so many structs: a power of two."""
    return 1 << (max(count - 1, 0) >> _BITS).bit_length()


def _field(dtype: np.dtype[Any], offset: int) -> str:
    base, count = dtype.base, dtype.itemsize // 4
    start = offset % _TEXEL // 4
    words = f"row{offset // _TEXEL}.{'xyzw'[start : start + count]}"
    if base.kind == "i" and count > 1:
        return f"ivec{count}({words})"
    return _CASTS[base.kind].format(words)
