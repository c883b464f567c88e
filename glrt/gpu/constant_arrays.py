"""GLSL of arrays that are constants of a kernel, and of the loops over them.

Drivers write a loop over constants out, so that its rows become operands of instructions. Mesa does
so for a loop over a whole array of up to 32 rows. Longer arrays therefore have two loops.
"""

from typing import Any, NamedTuple

import numpy as np

Array = np.ndarray[Any, Any]

LOOP = 32  # rows of the first of two loops


class Reads(NamedTuple):
    """A field of a constant struct that lies in the block READ, and its first row there."""

    field: str
    first: int


def constants(struct: str, rows: Array, getter: str, array: str, reads: Reads | None) -> str:
    """Return the GLSL of constants and of the function by which a kernel gets one."""
    function = getter_of(struct, getter, array)
    if reads:
        rows = rows.copy()
        rows[reads.field] = 0
        function = "\n".join(
            [
                f"{struct} {getter}(int index) {{",
                f"    {struct} row = {array}[index];",
                f"    row.{reads.field} = read_rows[{reads.first} + index].xyz;",
                "    return row;",
                "}",
            ]
        )
    listed = ",\n    ".join(constructor(struct, row) for row in rows)
    size = f"[{len(rows)}]"
    return f"const {struct} {array}{size} = {struct}{size}(\n    {listed});\n{function}"


def one_loop(struct: str) -> list[str]:
    """Return the functions of a loop over all rows; the second loop has none."""
    name = struct.lower()
    return [
        f"{struct} {name}_of_first(int index) {{ return {name}_at(index); }}",
        f"{struct} {name}_of_second(int index) {{ return {name}_at(index); }}",
        count_of(f"{name}_first", f"{name}_count()"),
        count_of(f"{name}_second", "0"),
    ]


def two_loops(struct: str, rows: Array, reads: Reads | None) -> list[str]:
    """Return the functions of two loops over constants."""
    name, parts = struct.lower(), []
    for half, some in (("first", rows[:LOOP]), ("second", rows[LOOP:])):
        getter = f"{name}_of_{half}"
        read = reads and Reads(reads.field, reads.first + LOOP * (half == "second"))
        text = constants(struct, some, getter, f"{name}_{half}_rows", read) if len(some) else ""
        parts += [text or nothing(struct, rows, getter), count_of(f"{name}_{half}", str(len(some)))]
    return parts


def count_of(name: str, value: str) -> str:
    """Return the function that gives a number of rows."""
    return f"int {name}_count() {{ return {value}; }}"


def getter_of(struct: str, getter: str, array: str) -> str:
    """Return the function that gives a row of an array."""
    return f"{struct} {getter}(int index) {{ return {array}[index]; }}"


def nothing(struct: str, rows: Array, getter: str) -> str:
    """Return the function of an empty array, which GLSL does not have: it gives zeros."""
    zero = constructor(struct, np.zeros(1, rows.dtype)[0])
    return f"{struct} {getter}(int index) {{ return {zero}; }}"


def constructor(struct: str, row: Any) -> str:
    """Return the GLSL of one row."""
    return f"{struct}({', '.join(literal(row[field]) for field in row.dtype.names)})"


def literal(value: Any) -> str:
    """Return a scalar or vector in GLSL, exactly: the shortest decimal that rounds to it."""
    if np.ndim(value):
        prefix = {"f": "", "i": "i", "u": "u"}[value.dtype.kind]
        return f"{prefix}vec{len(value)}({', '.join(literal(part) for part in value)})"
    if isinstance(value, np.floating):
        return np.format_float_scientific(value, unique=True, trim="0")
    return f"{value}u" if isinstance(value, np.unsignedinteger) else str(value)
