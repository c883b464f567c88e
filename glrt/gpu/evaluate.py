"""Evaluate shader expressions over arrays, for tests, the self-test and experiments."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import moderngl
import numpy as np

from glrt.gpu.glsl import Source, read
from glrt.gpu.program import Kernel, Resource

Array = np.ndarray[Any, Any]

_SCALARS = {"f": "float", "i": "int", "u": "uint"}
_CODES = {"float": "f4", "int": "i4", "uint": "u4", "bool": "u4"}
_GROUP = 64


@dataclass(frozen=True)
class Probe:
    """A GLSL expression that is computed once for each row of its inputs.

    `returns` is the GLSL type of the result ("float", "vec3", "uint", "bool"). `setup` are
    statements that stand before the expression, `functions` go in front of main. `includes` are
    shader files, `constants` their prelude.
    """

    expression: str
    returns: str = "float"
    setup: str = ""
    functions: str = ""
    includes: Sequence[str] = ()
    constants: Mapping[str, bool | int] | None = None
    texts: Mapping[str, str] | None = None  # texts in place of shader files, by name

    def run(
        self,
        gl: moderngl.Context,
        inputs: Mapping[str, Any] | None = None,
        blocks: Mapping[str, Resource] | None = None,
    ) -> Array:
        """Return the result for each row, (n,) or (n, 2..4); n is the length of the longest input.

        Inputs are arrays of floats, ints or uints, or (n, 2..4) vectors, named as in the
        expression; one of length 1 holds for all rows. `blocks` are the blocks and textures that
        included files or functions declare. The context must be current.
        """
        arrays = {name: _plain(values) for name, values in (inputs or {}).items()}
        count = max((len(values) for values in arrays.values()), default=1)
        base, width = _base(self.returns)
        kernel = Kernel(gl, self._source(arrays))
        own = {f"In_{name}": gl.buffer(values.tobytes()) for name, values in arrays.items()}
        own["Out"] = gl.buffer(reserve=4 * width * count)
        kernel.bind({**(blocks or {}), **own}, {})
        kernel.run_tiles(-(-count // _GROUP))
        result = np.frombuffer(own["Out"].read(), _CODES[base]).reshape(count, width)
        kernel.release()
        for buffer in own.values():
            buffer.release()
        out: Array = result[:, 0] if width == 1 else result
        return out.astype(bool) if base == "bool" else out

    def _needed(self) -> list[str]:
        """Return the files to include; compiling all of them would take most of the time."""
        text = " ".join([self.returns, self.setup, self.expression, self.functions])
        if "#include" in text:
            return list(self.includes)
        known = self.texts or {}
        return needed_files(text, {name: known.get(name) or read(name) for name in self.includes})

    def _source(self, arrays: Mapping[str, Array]) -> Source:
        base, width = _base(self.returns)
        stored = "uint" if base == "bool" else base
        parts = ["result_"] if width == 1 else [f"result_[{k}]" for k in range(width)]
        text = "\n".join(
            [
                f"layout(local_size_x = {_GROUP}) in;",
                *(f'#include "{name}"' for name in self._needed()),
                f"layout(std430) writeonly buffer Out {{ {stored} out_[]; }};",
                *(_block(name, values) for name, values in arrays.items()),
                self.functions,
                "void main() {",
                "    int i = int(gl_GlobalInvocationID.x);",
                f"    if (i >= out_.length() / {width}) return;",
                *(_local(name, values) for name, values in arrays.items()),
                self.setup,
                f"    {self.returns} result_ = {self.expression};",
                *(f"    out_[{width} * i + {k}] = {stored}({p});" for k, p in enumerate(parts)),
                "}",
            ]
        )
        return Source("probe", self.constants, texts={"probe": text, **(self.texts or {})})


_WORD = re.compile(r"[A-Za-z_]\w*")
_DECLARED = re.compile(r"^struct (\w+)|^(?:\w+ )+(\w+)(?=\(|\[| =|;)", re.MULTILINE)
# Directives and blocks; the names that they declare are not read here.
_ALWAYS = re.compile(r"^(?:#|layout|uniform|buffer)", re.MULTILINE)


def needed_files(text: str, files: Mapping[str, str]) -> list[str]:
    """Return the names of GLSL files that declare a word of a text, or of a file that does.

    `files` are texts in an order in which each builds on earlier ones alone. Files with directives
    or blocks are always needed.
    """
    words = set(_WORD.findall(text))
    found = []
    for name, content in reversed(list(files.items())):
        code = re.sub(r"//[^\n]*", "", content)
        declared = {struct or other for struct, other in _DECLARED.findall(code)}
        if _ALWAYS.search(code) or declared & words:
            found.append(name)
            words.update(_WORD.findall(code))
    return found[::-1]


_SHAPES = "shapes/all_shapes.glsl"  # includes, as trace.glsl does
_NO_RECORD = "integrators/no_record.glsl"  # entry files include it before trace.glsl


def path_files() -> list[str]:
    """Return the shader files that trace a path, in the order in which they build on each other."""
    text = read("trace.glsl").replace(f'#include "{_SHAPES}"', read(_SHAPES))
    return [_NO_RECORD, *re.findall(r'#include "([\w/]+\.glsl)"', text)]


def _plain(values: Any) -> Array:
    array = np.atleast_1d(np.asarray(values))
    if array.dtype.kind == "f":
        return array.astype(np.float32)
    return array.astype(np.uint32 if array.dtype.kind == "u" else np.int32)


def _base(glsl_type: str) -> tuple[str, int]:
    """Return the scalar type and the number of components: ("float", 3) for "vec3"."""
    if match := re.fullmatch(r"([iu]?)vec([234])", glsl_type):
        return {"": "float", "i": "int", "u": "uint"}[match[1]], int(match[2])
    return glsl_type, 1


def _block(name: str, values: Array) -> str:
    scalar = _SCALARS[values.dtype.kind]
    return f"layout(std430) readonly buffer In_{name} {{ {scalar} in_{name}[]; }};"


def _local(name: str, values: Array) -> str:
    scalar, row = _SCALARS[values.dtype.kind], "i" if len(values) > 1 else "0"
    if values.ndim == 1:
        return f"    {scalar} {name} = in_{name}[{row}];"
    width = values.shape[1]
    prefix = "" if scalar == "float" else scalar[0]
    parts = ", ".join(f"in_{name}[{width} * {row} + {k}]" for k in range(width))
    return f"    {prefix}vec{width} {name} = {prefix}vec{width}({parts});"
