"""Fixtures: one OpenGL context for the session, and shader functions run over arrays."""

import os
import shutil
import signal
from collections.abc import Callable, Iterator, Sequence
from ctypes.util import find_library
from pathlib import Path
from typing import Any

import moderngl
import numpy as np
import pytest

from bench.screens import screen
from glrt.core.errors import ContextError
from glrt.gpu import driver_checks
from glrt.gpu.context import Context, open_context
from glrt.plan.facts import SceneFacts
from glrt.plan.features import needs_of
from glrt.rendering.shader_functions import Expression, World, evaluate
from glrt.scene import lit_scene
from glrt.scene.scene import Scene
from glrt.settings import settings_for
from tests.support import profiles
from tests.support.system_packages import needs_package
from tests.wgsl.device import Device, open_device

pytest_plugins = ["tests.support.slow_share", "tests.support.alarms", "tests.support.budget"]

# A shell's background jobs ignore Ctrl-C, and so would every command that the tests start there.
signal.signal(signal.SIGINT, signal.default_int_handler)

# Some commands get an empty cache folder. Mesa keeps its kernels where it always does: to compile
# them again takes longer than the tests.
os.environ.setdefault(
    "MESA_SHADER_CACHE_DIR", os.environ.get("XDG_CACHE_HOME") or str(Path.home() / ".cache")
)

# There is a process for each core then; and of small pictures, llvmpipe's threads take several
# times the processor time that one takes.
if "PYTEST_XDIST_WORKER" in os.environ:
    os.environ.setdefault("LP_NUM_THREADS", "1")

Array = np.ndarray[Any, Any]
CallGlsl = Callable[..., Array]


@pytest.fixture(scope="session", autouse=True)
def shared_kernels() -> Iterator[None]:
    """Renderers compile the kernels of profiles, which many scenes share."""
    with profiles.shared():
        yield


@pytest.fixture
def exact_kernels() -> Iterator[None]:
    """Renderers compile what users get: each scene has a kernel of its own."""
    with profiles.exact():
        yield


@pytest.fixture(scope="session")
def context() -> Iterator[Context]:
    """The context that `auto` chooses on this machine."""
    opened = open_context("auto")
    yield opened
    opened.gl.release()


@pytest.fixture
def fresh(context: Context) -> Context:
    """The same context without any known program: it compiles, and measures, from the start."""
    return Context(context.gl, context.route, context.device)


@pytest.fixture
def loop_limit(context: Context, monkeypatch: pytest.MonkeyPatch) -> int:
    """The driver is taken to end loops after as many rounds as llvmpipe in Mesa 22 does."""
    driver = context.renderer, context.version
    monkeypatch.setitem(driver_checks._limits, driver, driver_checks.LLVMPIPE_ROUNDS)
    return driver_checks.LLVMPIPE_ROUNDS


@pytest.fixture
def ctx(context: Context) -> Iterator[moderngl.Context]:
    """The session's moderngl context, current, and free of GL errors before and after."""
    with context.gl:
        assert context.gl.error == "GL_NO_ERROR"
        yield context.gl
        assert context.gl.error == "GL_NO_ERROR"


@pytest.fixture(scope="session")
def webgpu() -> Device:
    """A WebGPU device."""
    try:
        return open_device()
    except ContextError as error:
        needs_package(False, f"mesa-vulkan-drivers ({error})")


@pytest.fixture(scope="session")
def display() -> Iterator[str]:
    """An X server without a screen, by its name."""
    needs_package(bool(shutil.which("Xvfb")), "xvfb")
    needs_package(bool(find_library("X11")), "libx11-6")
    with screen("1280x1100") as name:
        yield name


@pytest.fixture
def call_glsl(ctx: moderngl.Context) -> CallGlsl:
    """`call_glsl("fresnel(c, eta)", c=array, eta=array)`: a shader expression over arrays.

    Inputs are arrays of n floats, ints or uints, or (n, 2..4) vectors, named as in the
    expression; `returns` is the GLSL type of the result ("float", "vec3", "uint", "bool").
    `setup` are statements that stand before the expression; `functions` go in front of main.
    All files of the path text are included, by the independent sampler. Every feature is compiled
    in, or only the features of `scene` and its blocks. `constants` override the prelude, and
    `options` are settings in addition to the scene's.
    """

    def call(
        expression: str,
        returns: str = "float",
        setup: str = "",
        functions: str = "",
        scene: Scene | None = None,
        constants: dict[str, bool | int] | None = None,
        options: dict[str, Any] | None = None,
        **inputs: Any,
    ) -> Array:
        prelude: dict[str, bool | int] = {}
        settings = None
        if scene:
            settings = settings_for(scene.render, sampler="independent", **(options or {}))
            prelude = needs_of(SceneFacts(scene), settings).constants()
        prelude |= constants or {}
        text: Expression = {"returns": returns, "setup": setup, "functions": functions}
        return evaluate(ctx, expression, inputs, World(scene, settings, prelude), **text)

    return call


@pytest.fixture
def twins_stay(monkeypatch: pytest.MonkeyPatch) -> None:
    """Scenes show every object, also one that another one covers."""

    def shown(objects: Sequence[Any], materials: object) -> tuple[int, ...]:
        del materials
        return tuple(range(len(objects)))

    monkeypatch.setattr(lit_scene, "shown", shown)
