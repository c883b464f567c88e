"""The host and the driver agree about where every scalar of every struct lies."""

import re
from collections.abc import Iterator, Mapping
from typing import Any

import moderngl
import numpy as np
import pytest

from glrt.gpu.glsl import expanded, read
from glrt.gpu.program import TILE
from glrt.gpu.structs import read_constants, read_structs, record
from glrt.packing.shapes import NUMBERED

SCENE = expanded("structs/scene.glsl")
STRUCTS = read_structs(SCENE)
AWKWARD = """
struct Inner { vec3 a; uint b; vec2 c; };
struct Awkward {  // every rule that the shared structs may come to need
    float a;
    vec3 b;
    ivec2 c;  /* pixels;
    float not_a_field; */
    uint d;
    vec4 e;
    int f;
    Inner g;
    uvec3 h;
};
"""
NORMAL = 0x3F800000  # keeps every word, read as a float, clear of denormals
BLOCKS = {"storage": "layout(std430) readonly buffer", "uniform": "layout(std140) uniform"}


def scalars(dtype: np.dtype[Any], prefix: str = "", start: int = 0) -> Iterator[tuple[str, int]]:
    """The GLSL expression and the byte offset of every scalar of a struct."""
    assert dtype.fields is not None
    for name, (field, offset, *_) in dtype.fields.items():
        base, shape = field.subdtype or (field, ())
        for index in np.ndindex(shape):
            path = prefix + name + "".join(f"[{i}]" for i in index)
            at = start + offset + sum(index) * base.itemsize
            if base.names:
                yield from scalars(base, path + ".", at)
            else:
                yield path, at


def driver_offsets(
    gl: moderngl.Context, glsl: str, structs: Mapping[str, np.dtype[Any]], block: str
) -> dict[str, dict[str, int]]:
    """The byte offset of every scalar of some structs, as the driver has it.

    A block holds two of each struct, one struct after the other, and is filled with its own word
    numbers. A kernel that reads a scalar of the second learns where it lies: by the stride, too.
    """
    paths = [(name, path) for name in structs for path, _ in scalars(structs[name])]
    reads = "\n".join(f"result[{i}] = bits(two_{n}[1].{p});" for i, (n, p) in enumerate(paths))
    program = gl.compute_shader(f"""
        #version 430 core
        layout(local_size_x = 1) in;
        uint bits(float x) {{ return floatBitsToUint(x); }}
        uint bits(int x) {{ return uint(x); }}
        uint bits(uint x) {{ return x; }}
        {glsl}
        {BLOCKS[block]} Items {{ {" ".join(f"{name} two_{name}[2];" for name in structs)} }};
        layout(std430) writeonly buffer Result {{ uint result[]; }};
        void main() {{ {reads} }}
    """)
    sizes = [2 * dtype.itemsize for dtype in structs.values()]
    words = gl.buffer(np.arange(NORMAL, NORMAL + sum(sizes), dtype=np.uint32))
    result = gl.buffer(reserve=4 * len(paths))
    program["Items"].binding, program["Result"].binding = 0, 1  # type: ignore[union-attr]
    (words.bind_to_storage_buffer if block == "storage" else words.bind_to_uniform_block)(0)
    result.bind_to_storage_buffer(1)
    program.run(1)
    found = 4 * (np.frombuffer(result.read(), np.uint32).astype(np.int64) - NORMAL)
    for resource in (words, result, program):
        resource.release()
    first = dict(zip(structs, np.cumsum([0, *sizes[:-1]]).tolist(), strict=True))
    offsets: dict[str, dict[str, int]] = {name: {} for name in structs}
    for (name, path), at in zip(paths, found.tolist(), strict=True):
        offsets[name][path] = at - first[name] - structs[name].itemsize
    return offsets


def agrees(gl: moderngl.Context, glsl: str, name: str, dtype: np.dtype[Any], block: str) -> bool:
    return driver_offsets(gl, glsl, {name: dtype}, block)[name] == dict(scalars(dtype))


@pytest.mark.parametrize("block", BLOCKS)
def test_the_driver_reads_each_field_where_the_host_writes_it(
    ctx: moderngl.Context, block: str
) -> None:
    host = {name: dict(scalars(dtype)) for name, dtype in STRUCTS.items()}
    assert driver_offsets(ctx, SCENE, STRUCTS, block) == host


@pytest.mark.parametrize("block", BLOCKS)
def test_awkward_orders_of_fields_are_laid_out_as_the_driver_does(
    ctx: moderngl.Context, block: str
) -> None:
    awkward = read_structs(AWKWARD)["Awkward"]
    assert agrees(ctx, AWKWARD, "Awkward", awkward, block)


@pytest.mark.parametrize("block", BLOCKS)
def test_numpys_own_packing_is_caught(ctx: moderngl.Context, block: str) -> None:
    packed = np.dtype([("a", "f4"), ("b", "f4", 3), ("c", "u4")])
    glsl = "struct Packed { float a; vec3 b; uint c; };"
    assert not agrees(ctx, glsl, "Packed", packed, block)
    assert agrees(ctx, glsl, "Packed", read_structs(glsl)["Packed"], block)


def test_a_wrong_stride_is_caught_though_every_offset_is_right(ctx: moderngl.Context) -> None:
    right = STRUCTS["Plane"]
    assert right.fields is not None
    names = list(right.names or ())
    layout = {"names": names, "formats": [right.fields[n][0] for n in names]}
    short = np.dtype({**layout, "offsets": [right.fields[n][1] for n in names], "itemsize": 28})  # type: ignore[call-overload]
    assert dict(scalars(short)) == dict(scalars(right))
    assert not agrees(ctx, SCENE, "Plane", short, "storage")


def test_all_structs_of_the_shader_file_are_read() -> None:
    others = (
        "Corner Tint Triangle Instance Node Slot Material Emitter Conductor Glass Gloss Albedo Map "
        "Maps Axes Uv Tangent Light Cluster Target Sides Aim Medium Boundary "
        "Camera Frame"
    )
    assert set(STRUCTS) == {*NUMBERED, *others.split()}
    assert SCENE.count("struct ") == len(STRUCTS)


@pytest.mark.parametrize(
    "glsl",
    [
        "struct S { double x; };",
        "struct S { float x[3]; };",
        "struct S { float[3] x; };",
        "struct S { mat3 x; };",
        "struct S { Unknown x; };",
        "struct S { float x, y; };",
        "struct S { const float x; };",
        "struct S { bool x; };",
    ],
)
def test_a_field_that_is_not_plain_is_refused_by_name(glsl: str) -> None:
    with pytest.raises(KeyError, match=r"struct S: `.*x.*` is not a plain field"):
        read_structs(glsl)


@pytest.mark.parametrize("fields", ["float a; float b;", "vec3 a; float b; int c; Four d;"])
def test_a_struct_that_uniform_and_storage_blocks_lay_out_differently_is_refused(
    fields: str,
) -> None:
    with pytest.raises(KeyError, match="struct S: std140 and std430 differ"):
        read_structs(f"struct Four {{ int a; int b; int c; int d; }}; struct S {{ {fields} }};")


def test_the_driver_does_lay_out_such_a_struct_differently(ctx: moderngl.Context) -> None:
    glsl = "struct S { float a; float b; };"
    formats = {"names": ["a", "b"], "formats": ["f4", "f4"], "offsets": [0, 4], "itemsize": 16}
    row = np.dtype(formats)  # type: ignore[call-overload]
    assert agrees(ctx, glsl, "S", row, "uniform")
    assert not agrees(ctx, glsl, "S", row, "storage")


def test_constants_are_read_with_their_signs_and_not_from_comments() -> None:
    glsl = "const int A = 3; // const int B = 4;\nconst int C = -1;\n/* const int D = 5; */"
    assert read_constants(glsl) == {"A": 3, "C": -1}
    assert read_constants(SCENE)["NO_SHAPE"] == -1


def test_a_record_holds_what_it_was_given() -> None:
    dtype = read_structs(AWKWARD)["Awkward"]
    inner = {"a": (9, 10, 11), "b": 12, "c": (13, 14)}
    row = record(
        dtype,
        {"a": 1, "b": (2, 3, 4), "c": (5, 6), "d": 7, "e": 8, "f": -9, "g": inner, "h": 0},
    )[0]
    assert (row["a"], row["d"], row["f"], row["g"]["b"]) == (1, 7, -9, 12)
    assert row["b"].tolist() == [2, 3, 4]
    assert row["g"]["c"].tolist() == [13, 14]


def test_a_record_refuses_missing_and_foreign_names() -> None:
    dtype = read_structs("struct S { vec3 a; float b; };")["S"]
    with pytest.raises(KeyError, match="b"):
        record(dtype, {"a": (1, 2, 3)})
    with pytest.raises(KeyError, match=r"no field \['c'\]"):
        record(dtype, {"a": (1, 2, 3), "b": 1, "c": 2})
    nested = read_structs(AWKWARD)["Awkward"]
    whole = {"a": 1, "b": 1, "c": 1, "d": 1, "e": 1, "f": 1, "h": 1}
    with pytest.raises(KeyError, match="c"):
        record(nested, {**whole, "g": {"a": 1, "b": 1}})


def test_a_work_group_of_the_path_tracer_is_a_tile() -> None:
    """OpenGL 4.3 takes numbers alone for its size, and no constants."""
    group = re.search(r"local_size_x = (\d+), local_size_y = (\d+)", read("trace.comp"))
    assert group
    assert [int(side) for side in group.groups()] == [TILE, TILE]
