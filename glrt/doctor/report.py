"""Report which OpenGL routes work here, how their drivers behave, and what helps if none works.

Each route is tried in a process of its own: a driver that crashes or hangs is a finding, and does
not end `glrt doctor`.
"""

import json
import platform
import signal
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from importlib.metadata import version
from importlib.util import find_spec
from typing import Any, NamedTuple

from glrt.core.install import install
from glrt.core.version import VERSION
from glrt.doctor.install_hints import remedies
from glrt.gpu.context import MOST_DEVICES, ROUTES
from glrt.gpu.driver_checks import MOST_ROUNDS
from glrt.plan.combinations import MEANINGS, Way

# Purpose of each extra of the package, and the modules that it installs.
EXTRAS = {
    "view": ("the window", ("imgui_bundle", "glfw")),
    "chart": ("charts and stress tests", ("matplotlib",)),
    "flip": ("FLIP in charts, in addition to the error", ("flip_evaluator",)),
}


def lacking(has_compute: bool) -> list[str]:
    """Return a line for each missing feature; `has_compute`: whether compute shaders work."""
    missing = [
        f"{purpose}: {install(extra)}"
        for extra, (purpose, modules) in EXTRAS.items()
        if not all(map(find_spec, modules))
    ]
    if not has_compute:
        layers = f"{Way.LAYERS} ({MEANINGS[Way.LAYERS]})"
        missing.append(f"{layers}: needs compute shaders, OpenGL 4.3")
    return missing


PATIENCE = 120  # seconds for one route: a software driver may compile for some of them
PIPELINES = ("compute", "fragment")
EXACT = 1e-5  # relative error below which a furnace counts as right, on any driver

Finding = dict[str, Any]


@dataclass(frozen=True)
class Examination:
    """Findings about one device of a route."""

    route: str
    device: int
    found: dict[str, Finding]  # by step, in order: open, fragment, self_test, compute, end
    end: str  # how the process failed; "" if it ran to its end

    @property
    def opens(self) -> bool:
        """Whether an OpenGL context could be opened."""
        return "renderer" in self.found.get("open", {})

    @property
    def works(self) -> bool:
        """Whether one of the pipelines renders the furnace correctly."""
        return any(self.found.get(step, {}).get("furnace", 1.0) < EXACT for step in PIPELINES)


class Used(NamedTuple):
    """Route and device that a render uses by default."""

    route: str
    device: int


def examine(route: str, device: int = 0, command: Sequence[str] = ()) -> Examination:
    """Examine a device of a route in a separate process; tests replace it by `command`."""
    arguments = command or (sys.executable, "-m", "glrt.doctor.route_process", route, str(device))
    try:
        done = subprocess.run(arguments, capture_output=True, text=True, timeout=PATIENCE)
    except subprocess.TimeoutExpired as error:
        return Examination(route, device, _read(_text(error.stdout)), "no answer; it was stopped")
    found = _read(done.stdout)
    return Examination(route, device, found, "" if "end" in found else _death(done))


def examine_all() -> list[Examination]:
    """Examine every route, and every device of EGL."""
    examinations = []
    for route in ROUTES:
        for device in range(MOST_DEVICES if route == "egl" else 1):
            examination = examine(route, device)
            if device and not examination.opens and not examination.end:
                break  # EGL has no more devices
            examinations.append(examination)
    return examinations


def report(as_json: bool = False) -> tuple[str, bool]:
    """Return the report, as text or as one line of JSON, and whether any route works."""
    examinations = examine_all()
    used = _used(examine("auto"))
    works = any(examination.works for examination in examinations)
    if as_json:
        lacks = lacking(_has_compute(used, examinations))
        return json.dumps({**_table(examinations, used), "lacks": lacks}), works
    lines = [_versions(), ""]
    for examination in examinations:
        lines += [*_lines(examination, used), ""]
    lines += [f"Not available here: {text}." for text in lacking(_has_compute(used, examinations))]
    return "\n".join([*lines, _verdict(used, examinations)]), works


def _used(auto: Examination) -> Used | None:
    """Return the route and device that `auto` chose; None if it opened none."""
    opening = auto.found.get("open", {})
    return Used(opening["route"], opening["device"]) if "route" in opening else None


def _has_compute(used: Used | None, examinations: list[Examination]) -> bool:
    """Whether compute shaders work on the route that a render uses by default."""
    chosen = [examination for examination in examinations if _is_of(examination, used)]
    return any(e.found.get("compute", {}).get("furnace", 1.0) < EXACT for e in chosen)


def _table(examinations: list[Examination], used: Used | None) -> Finding:
    routes = [
        {"route": e.route, "device": e.device, "works": e.works, **e.found, "end": e.end or None}
        for e in examinations
    ]
    route, device = used or (None, None)
    return {"version": VERSION, "used": route, "used_device": device, "routes": routes}


def _read(text: str) -> dict[str, Finding]:
    found = {}
    for line in text.splitlines():
        if line.startswith("{"):
            finding = json.loads(line)
            found[finding.pop("step")] = finding
    return found


def _text(output: bytes | str | None) -> str:
    return output.decode(errors="replace") if isinstance(output, bytes) else output or ""


def _death(done: "subprocess.CompletedProcess[str]") -> str:
    last = (done.stderr.strip().splitlines() or ["no message"])[-1]
    if done.returncode < 0:
        return f"the driver crashed ({signal.Signals(-done.returncode).name}): {last}"
    return f"the process ended with code {done.returncode}: {last}"


def _versions() -> str:
    packages = ", ".join(f"{name} {version(name)}" for name in ("moderngl", "numpy", "pydantic"))
    system = f"{platform.system()} {platform.machine()}"
    return f"glrt {VERSION}, Python {platform.python_version()}, {packages}, {system}"


def _lines(examination: Examination, used: Used | None) -> list[str]:
    name = examination.route + (f" {examination.device}" if examination.device else "")
    if not examination.opens:
        opening = examination.found.get("open", {})
        reason = opening.get("error", "").removeprefix(f"{examination.route}: ") or examination.end
        return [f"{name:<8}does not work: {reason} ({_hint(examination.route)})"]
    opening = examination.found["open"]
    kind = "software" if opening["is_software"] else "hardware"
    is_used = " <- used" if _is_of(examination, used) else ""
    lines = [
        f"{name:<8}{'works' if examination.works else 'does not work'}: {opening['renderer']}, "
        f"{kind}, OpenGL {opening['version']}, opened in {opening['seconds']:.2f} s{is_used}"
    ]
    absence = "no answer" if examination.end else "not there"
    for step in PIPELINES:
        lines.append(f"  {step:<14}{_furnace(examination.found.get(step)) or absence}")
    lines += findings(examination.found.get("self_test"))
    return lines + ([f"  {examination.end}"] if examination.end else [])


def _is_of(examination: Examination, used: Used | None) -> bool:
    return (examination.route, examination.device) == used


def _hint(route: str) -> str:
    hints = {
        "window": "needs a display, or `xvfb-run`",
        "osmesa": "not needed: EGL has the same software OpenGL",
    }
    return hints.get(route, "; ".join(remedies()))


def _furnace(finding: Finding | None) -> str:
    if finding is None:
        return ""
    if "error" in finding:
        return f"fails: {finding['error']}"
    error = finding["furnace"]
    exactness = "exact to the last bit" if error == 0 else f"off by {error:.1e}"
    return f"a furnace is {exactness} (with compiling {finding['seconds']:.2f} s)"


def _verdict(used: Used | None, examinations: list[Examination]) -> str:
    if not any(examination.works for examination in examinations):
        wanted = "No route works: glrt needs OpenGL 4.1, and 4.3 to be fast. To mend that:"
        return "\n".join([wanted, *remedies()])
    chosen = next((e for e in examinations if _is_of(e, used)), examinations[0])
    route = used.route if used else chosen.route
    if "compute" in chosen.found or not chosen.end:
        return f"`glrt render` uses {route}; --context chooses another, --pipeline the pipeline."
    return f"`glrt render` uses {route}, whose compute shaders fail: use --pipeline fragment."


def findings(found: Finding | None) -> list[str]:
    """Return a line for each property of the driver that the self-test measured."""
    if found is None:
        return ["  the self-test needs compute shaders, which OpenGL 4.3 brings"]
    if "error" in found:
        return [f"  the self-test failed: {found['error']}"]
    endless = found["loop_limit"] >= MOST_ROUNDS
    loops = (
        f"run for {MOST_ROUNDS:,} rounds and more"
        if endless
        else f"end silently after {found['loop_limit']:,} rounds; dispatches stay below"
    )
    ulps = ", ".join(f"{name} {error:.2g}" for name, error in found["ulps"].items())
    kept = "kept" if found["precise_kept"] else "NOT KEPT: the bits of pictures may vary"
    free = "fused or reordered" if found["fuses_without"] else "computed as written, too"
    equal = "those of Python's integers" if found["hashes_equal"] else "WRONG: pictures are too"
    return [
        f"  loops         {loops}",
        f"  random        {equal}",
        f"  precise       {kept}; without it, sums and products are {free}",
        f"  largest error {ulps} units in the last place",
        f"                sin and cos {found['trig_error']:.2g} x 2^-24",
    ]
