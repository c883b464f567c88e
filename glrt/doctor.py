"""Which OpenGL routes work on this machine, and what to do if none does."""

import platform
import time
from importlib.metadata import version

from glrt.context import ADVICE, ROUTES, open_context, open_route
from glrt.errors import ContextError
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
    seconds = time.perf_counter() - start
    context.gl.release()
    used = " <- used" if route == chosen else ""
    return [f"{text}, opened in {seconds:.2f} s{used}"]


def _verdict(chosen: str) -> str:
    if chosen:
        return f"`glrt render` uses {chosen}; --context chooses another."
    return f"No route gives OpenGL 4.3. {ADVICE}"
