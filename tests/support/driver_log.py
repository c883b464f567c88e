"""The driver's log of a shader that compiles: moderngl does not report warnings."""

import ctypes
import os
import uuid

import pytest

COMPUTE, VERTEX, FRAGMENT = 0x91B9, 0x8B31, 0x8B30
_COMPILE_STATUS, _LINK_STATUS, _LOG_LENGTH = 0x8B81, 0x8B82, 0x8B84


def compile_log(*stages: tuple[int, str]) -> str:
    """Compile and link `(stage, text)` in the current context; all that the driver has to say.

    Text that the driver refuses is an AssertionError with its message.
    """
    gl = library()
    program = gl.glCreateProgram()
    shaders = [_compile(gl, stage, text) for stage, text in stages]
    for shader, _ in shaders:
        gl.glAttachShader(program, shader)
        gl.glDeleteShader(shader)
    gl.glLinkProgram(program)
    linked = _report(gl, "Program", program, _LINK_STATUS)
    gl.glDeleteProgram(program)
    return "\n".join(filter(None, [*(log for _, log in shaders), linked]))


def warnings(*stages: tuple[int, str]) -> list[str]:
    """The lines of the driver's messages that warn."""
    return [line for line in compile_log(*stages).splitlines() if "warning" in line.lower()]


def _compile(gl: ctypes.CDLL, stage: int, text: str) -> tuple[int, str]:
    text += f"// {uuid.uuid4()}\n"  # a text in the driver's cache is not compiled: no warning
    shader = gl.glCreateShader(stage)
    gl.glShaderSource(shader, 1, ctypes.byref(ctypes.c_char_p(text.encode())), None)
    gl.glCompileShader(shader)
    return shader, _report(gl, "Shader", shader, _COMPILE_STATUS)


def _report(gl: ctypes.CDLL, kind: str, name: int, status: int) -> str:
    """The log of a shader or a program."""
    good, length = ctypes.c_int(), ctypes.c_int()
    ask = getattr(gl, f"glGet{kind}iv")
    ask(name, status, ctypes.byref(good))
    ask(name, _LOG_LENGTH, ctypes.byref(length))
    buffer = ctypes.create_string_buffer(max(length.value, 1))
    getattr(gl, f"glGet{kind}InfoLog")(name, len(buffer), None, buffer)
    log = buffer.value.decode(errors="replace").strip()
    assert good.value, log
    return log


def library() -> ctypes.CDLL:
    try:
        return ctypes.CDLL("libGL.so.1")
    except OSError:
        missing = "the driver's log is read through libGL.so.1 (Debian: libgl1)"
        if os.environ.get("CI"):
            pytest.fail(missing)
        pytest.skip(missing)
