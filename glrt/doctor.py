"""Which OpenGL routes work on this machine, what the driver does, and what to do if none works."""

import platform
import time
from importlib.metadata import version

from glrt.context import ADVICE, ROUTES, open_context, open_route
from glrt.errors import ContextError, GlrtError
from glrt.selftest import MOST_ROUNDS, SelfTest, self_test
from glrt.version import VERSION

_HINTS = {
    "egl": "Debian: libegl1 libegl-mesa0 libgl1 libgl1-mesa-dri",
    "window": "needs a display, or `xvfb-run`",
    "osmesa": "Debian: libosmesa6; Mesa 25.1 and later have none",
}


def report() -> tuple[str, bool]:
    """What works here, as text, and whether anything does."""
    chosen = _chosen()
    lines = [_versions(), ""]
    lines += [line for route in ROUTES for line in _route_lines(route, chosen)]
    lines += ["", _verdict(chosen)]
    if chosen:
        lines += ["", *_self_test_lines()]
    return "\n".join(lines), bool(chosen)


def _versions() -> str:
    packages = ", ".join(f"{name} {version(name)}" for name in ("moderngl", "numpy", "pydantic"))
    system = f"{platform.system()} {platform.machine()}"
    return f"glrt {VERSION}, Python {platform.python_version()}, {packages}, {system}"


def _chosen() -> str:
    try:
        context = open_context("auto")
    except ContextError:
        return ""
    context.gl.release()
    return context.route


def _route_lines(route: str, chosen: str) -> list[str]:
    start = time.perf_counter()
    try:
        context = open_route(route)
    except ContextError as error:
        reason = " ".join(str(error).split()).removeprefix(f"{route}: ")
        return [f"{route:<8}does not work: {reason} ({_HINTS[route]})"]
    kind = "software" if context.is_software else "hardware"
    text = f"{route:<8}works: {context.renderer}, {kind}, OpenGL {context.version}"
    text += "" if context.has_compute else ", fragment pipeline"
    seconds = time.perf_counter() - start
    context.gl.release()
    used = " <- used" if route == chosen else ""
    return [f"{text}, opened in {seconds:.2f} s{used}"]


def _verdict(chosen: str) -> str:
    if chosen:
        return f"`glrt render` uses {chosen}; --context chooses another."
    return f"No route gives OpenGL 4.1. {ADVICE}"


def _self_test_lines() -> list[str]:
    context = open_context("auto")
    if not context.has_compute:
        context.gl.release()
        return ["The self-test needs compute shaders, which OpenGL 4.3 brings."]
    try:
        lines = findings(self_test(context))
    except GlrtError as error:
        lines = [f"  the self-test failed: {error}"]
    finally:
        context.gl.release()
    return [f"What {context.renderer} does:", *lines]


def findings(found: SelfTest) -> list[str]:
    """One line for each thing that the driver was tried for."""
    endless = found.loop_limit >= MOST_ROUNDS
    loops = (
        f"run for {MOST_ROUNDS:,} rounds and more"
        if endless
        else f"end silently after {found.loop_limit:,} rounds; dispatches stay below"
    )
    ulps = ", ".join(f"{name} {error:.2g}" for name, error in found.ulps.items())
    kept = "kept" if found.precise_kept else "NOT KEPT: the bits of pictures may vary"
    free = "fused or reordered" if found.fuses_without else "computed as written, too"
    equal = "those of Python's integers" if found.hashes_equal else "WRONG: pictures are too"
    return [
        f"  loops           {loops}",
        f"  random numbers  {equal}",
        f"  precise         {kept}; without it, sums and products are {free}",
        f"  largest error   {ulps} units in the last place",
        f"                  sin and cos {found.trig_error:.2g} x 2^-24",
    ]
