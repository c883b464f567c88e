"""How the kernel reads the scene: `blocks.glsl` with each array declared the fastest way it can be.

Three tiers, the same values: "baked" writes the shapes into the kernel's text, so that each edit
of them compiles; "generic" reads uniform blocks, and textures for what is larger than those may be;
"storage" reads storage blocks, as in the file. Figures stand in docs/speed.md.
"""

from collections.abc import Mapping
from typing import Any, Literal

import numpy as np

from glrt.gpu.glsl import read
from glrt.gpu.texels import accessor

Array = np.ndarray[Any, Any]
Tier = Literal["storage", "generic", "baked"]

BAKED = ("Spheres", "Planes", "Quads")  # not materials: a colour is to change without compiling
MOST_BAKED = 32  # shapes
UNIFORM_BYTES = 16_384  # every OpenGL grants a uniform block this much
LEAST_ROWS = 32


def tier_for(arrays: Mapping[str, Array], wanted: Tier) -> Tier:
    """The tier that a scene gets: not baked if it has more than MOST_BAKED shapes."""
    shapes = sum(len(arrays[name]) for name in BAKED)
    return "generic" if wanted == "baked" and shapes > MOST_BAKED else wanted


def blocks_text(
    arrays: Mapping[str, Array],
    tier: Tier = "generic",
    has_storage: bool = True,
    uniform_bytes: int = UNIFORM_BYTES,
) -> str:
    """The text of `blocks.glsl` for these arrays, keyed by block name.

    Uniform blocks are at most `uniform_bytes` large; what is larger lies in textures. These
    stand in for storage blocks too where there are none, as in OpenGL 4.1.
    """
    text = read("blocks.glsl")
    for block, rows in arrays.items():
        struct = block.removesuffix("s")
        name = struct.lower()
        storage = f"layout(std430) readonly buffer {block} {{ {struct} {name}s[]; }};"
        if storage not in text:
            raise KeyError(f"blocks.glsl does not declare `{storage}`")
        if tier == "baked" and block in BAKED:
            text = text.replace(storage, _constants(struct, f"{name}s", rows))
            text = text.replace(f"frame.{name}_count", str(len(rows)))
        elif is_uniform(rows, tier, uniform_bytes):
            uniform = f"layout(std140) uniform {block} {{ {struct} {name}s[{_capacity(rows)}]; }};"
            text = text.replace(storage, uniform)
        elif tier != "storage" or not has_storage:
            getter = f"{struct} {name}_at(int index) {{ return {name}s[index]; }}"
            text = text.replace(storage, "").replace(getter, accessor(struct, block, rows))
    return text


def padded(rows: Array, tier: Tier, uniform_bytes: int = UNIFORM_BYTES) -> bytes:
    """The content of a block's buffer: as large as the uniform block, and never empty."""
    least = _capacity(rows) if is_uniform(rows, tier, uniform_bytes) else 1
    return rows.tobytes().ljust(least * rows.itemsize, b"\0")


def is_uniform(rows: Array, tier: Tier, uniform_bytes: int = UNIFORM_BYTES) -> bool:
    """Whether an array that is not baked lies in a uniform block."""
    return tier != "storage" and _capacity(rows) * rows.itemsize <= uniform_bytes


def _capacity(rows: Array) -> int:
    """Rows of a uniform block: some to spare, so that adding a shape seldom compiles.

    Not as many as there may be: with blocks of 64 KiB llvmpipe compiled for 4.5 s, not 0.6.
    """
    return max(LEAST_ROWS, 1 << (len(rows) - 1).bit_length())


def _constants(struct: str, name: str, rows: Array) -> str:
    values = rows if len(rows) else np.zeros(1, rows.dtype)  # an array cannot be empty
    listed = ",\n    ".join(_constructor(struct, row) for row in values)
    kind = f"{struct}[{len(values)}]"
    return f"const {struct} {name}[{len(values)}] = {kind}(\n    {listed});"


def _constructor(struct: str, row: Any) -> str:
    return f"{struct}({', '.join(_literal(row[field]) for field in row.dtype.names)})"


def _literal(value: Any) -> str:
    """A scalar or vector in GLSL, to the last bit: the shortest decimal that rounds to it."""
    if np.ndim(value):
        return f"vec{len(value)}({', '.join(_literal(part) for part in value)})"
    if isinstance(value, np.floating):
        return np.format_float_scientific(value, unique=True, trim="0")
    return str(value)
