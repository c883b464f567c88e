"""The OpenGL context of the window for moderngl, and whether a window can be opened."""

import ctypes
import os
import sys
from typing import Any

from imgui_bundle import hello_imgui  # first: glfw then is the library that it brings

import glfw  # isort: skip
import moderngl

from glrt.core.errors import ContextError
from glrt.gpu.context import COMPUTE, FRAGMENT, Context, Pipeline

INSTEAD = "Use `glrt render`, which needs no window; `glrt doctor` shows which OpenGL works here."


class WindowLoader:
    """OpenGL functions by name, for moderngl; the window's context is always current."""

    def load_opengl_function(self, name: str) -> int:
        """Return the address of an OpenGL function; 0 if there is none."""
        return ctypes.cast(glfw.get_proc_address(name), ctypes.c_void_p).value or 0

    def __enter__(self) -> "WindowLoader":
        return self

    def __exit__(self, *_: object) -> None:
        """Leave the context current."""

    def release(self) -> None:
        """Do nothing: the window owns the context."""


def wrap_window() -> Context:
    """Return the context of the open window for glrt."""
    loader: Any = WindowLoader()
    return Context(moderngl.create_context(require=FRAGMENT, context=loader), "window")


def window_options(version: int) -> hello_imgui.OpenGlOptions:
    """Return OpenGL options without antialiasing, which doubles the time of software drivers."""
    options = hello_imgui.OpenGlOptions()
    options.major_version, options.minor_version = divmod(version // 10, 10)
    options.use_core_profile, options.anti_aliasing_samples = True, 0
    return options


def window_version(pipeline: Pipeline = "auto") -> int:
    """Return the OpenGL version to open a window with: 430, with compute shaders, else 410.

    Raises ContextError if no window can be opened, or only one too old for the pipeline.
    """
    problems: list[str] = []
    report: Any = glfw.set_error_callback
    report(lambda _code, message: problems.append(os.fsdecode(message).strip()))
    versions = (COMPUTE,) if pipeline == "compute" else (COMPUTE, FRAGMENT)
    version = next(filter(_opens, versions), None) if glfw.init() else None
    glfw.terminate()
    report(None)
    if version is None:
        needed = versions[-1] / 100
        reason = "; ".join(dict.fromkeys(problems)) or "no reason given"
        raise ContextError(f"no window with OpenGL {needed} can be opened: {reason}. {INSTEAD}")
    return version


def _opens(version: int) -> bool:
    major, minor = divmod(version // 10, 10)
    glfw.window_hint(glfw.VISIBLE, glfw.FALSE)
    glfw.window_hint(glfw.OPENGL_FORWARD_COMPAT, sys.platform == "darwin")  # macOS insists on it
    glfw.window_hint(glfw.CONTEXT_VERSION_MAJOR, major)
    glfw.window_hint(glfw.CONTEXT_VERSION_MINOR, minor)
    glfw.window_hint(glfw.OPENGL_PROFILE, glfw.OPENGL_CORE_PROFILE)
    window = glfw.create_window(16, 16, "glrt", None, None)
    if not window:
        return False
    glfw.destroy_window(window)
    return True
