"""The doctor separates what works from what does not, and no driver's crash ends it."""

import json
import sys
from collections.abc import Callable
from ctypes.util import find_library
from dataclasses import replace
from typing import Any

import pytest

from glrt.core.install import install
from glrt.doctor import install_hints, route_process
from glrt.doctor import report as doctor
from glrt.doctor.report import Examination, examine, report
from glrt.gpu.context import ROUTES, Context

OPENED = (
    '{"step": "open", "renderer": "toy", "version": "4.5", "is_software": true, '
    '"has_compute": true, "seconds": 0.1}'
)
RIGHT = '{"step": "fragment", "furnace": 0.0, "seconds": 0.2}'


def dying(lines: list[str], last: str) -> Examination:
    """The examination of a driver that shows these lines, and then does this."""
    code = f"print({chr(10).join(lines)!r}, flush=True)\nimport os, sys, time\n{last}"
    return examine("egl", command=[sys.executable, "-c", code])


@pytest.fixture(scope="module")
def examined() -> list[Examination]:
    """The doctor's findings on this machine, without a display."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("DISPLAY", "")
        return doctor.examine_all()


@pytest.fixture
def told(examined: list[Examination], monkeypatch: pytest.MonkeyPatch) -> Callable[..., str]:
    """The doctor's report of that."""
    auto = Examination("auto", 0, {"open": {"route": "egl", "device": 0}}, "")
    monkeypatch.setattr(doctor, "examine_all", lambda: examined)
    monkeypatch.setattr(doctor, "examine", lambda _: auto)
    return lambda **how: report(**how)[0]


def test_each_route_is_examined_and_the_one_that_is_used_is_named(told: Callable[..., str]) -> None:
    lines = told().splitlines()
    assert any(line.startswith("egl     works: ") and line.endswith("<- used") for line in lines)
    has_osmesa = bool(find_library("OSMesa"))
    assert any(line.startswith("osmesa  works: ") for line in lines) == has_osmesa
    assert any(line.startswith("window  does not work: there is no display") for line in lines)
    exact = sum("a furnace is exact to the last bit" in line for line in lines)
    assert exact == (4 if has_osmesa else 2)
    assert "  random        those of Python's integers" in lines


def test_json_has_the_findings_of_every_route(told: Callable[..., str]) -> None:
    table = json.loads(told(as_json=True))
    routes = {entry["route"]: entry for entry in table["routes"]}
    assert table["used"] == "egl"
    assert routes["egl"]["works"]
    assert routes["egl"]["fragment"]["furnace"] == 0
    assert routes["egl"]["end"] is None
    assert not routes["window"]["works"]


def test_the_mark_stands_at_the_device_that_is_used(
    examined: list[Examination], told: Callable[..., str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """A graphics processor may be the second of EGL's devices."""
    works = next(each for each in examined if each.opens)
    auto = Examination("auto", 0, {"open": {"route": "egl", "device": 1}}, "")
    both = [replace(works, route="egl", device=device) for device in (0, 1)]
    monkeypatch.setattr(doctor, "examine_all", lambda: both)
    monkeypatch.setattr(doctor, "examine", lambda _: auto)
    lines = [line for line in told().splitlines() if line.startswith("egl ")]
    assert [line.endswith("<- used") for line in lines] == [False, True]
    assert json.loads(told(as_json=True))["used_device"] == 1


def test_auto_says_which_route_a_render_would_use() -> None:
    opened = examine("auto").found["open"]
    assert opened["route"] in ROUTES
    assert opened["device"] >= 0


def test_a_driver_that_crashes_is_a_finding() -> None:
    examined = dying([OPENED, RIGHT], "os.abort()")
    assert examined.works, "what it did before stands"
    assert "crashed (SIGABRT)" in examined.end
    assert not dying([OPENED], "os.abort()").works
    assert not dying([], "os.abort()").opens


def test_a_driver_that_hangs_is_stopped(monkeypatch: pytest.MonkeyPatch) -> None:
    for patience in (1, 10, 60):  # seconds, in which a busy machine must start Python
        monkeypatch.setattr(doctor, "PATIENCE", patience)
        examined = dying([OPENED], "time.sleep(100)")
        if examined.opens:
            break
    assert examined.opens
    assert examined.end == "no answer; it was stopped"


def test_what_a_process_dies_of_is_reported() -> None:
    examined = dying([], "sys.exit('out of patience')")
    assert examined.end == "the process ended with code 1: out of patience"


@pytest.mark.slow_cases("fragment")
@pytest.mark.parametrize("pipeline", ["compute", "fragment"])
def test_a_furnace_that_is_wrong_does_not_pass(
    pipeline: Any, context: Context, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert route_process.furnace(context, pipeline) < doctor.EXACT
    materials = {"wall": {"type": "light", "emission": [1, 1, 1], "color": [0.5, 0.5, 0.499]}}
    monkeypatch.setitem(route_process._ROOM, "materials", materials)
    error = route_process.furnace(context, pipeline)
    assert error > doctor.EXACT
    found: dict[str, Any] = {"open": {"renderer": "toy"}, pipeline: {"furnace": error}}
    assert not Examination("egl", 0, found, "").works


def test_exit_code_and_advice_when_nothing_works(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    from glrt.cli.main import main

    refused = {"open": {"error": "egl: no such library", "seconds": 0.0}, "end": {}}
    monkeypatch.setattr(
        doctor, "examine", lambda route, device=0: Examination(route, 0, refused, "")
    )
    monkeypatch.setattr(install_hints, "systems_here", lambda: ["Debian, Ubuntu", "Docker"])
    assert main(["doctor"]) == 3
    told = capsys.readouterr().out
    assert "No route works" in told
    assert "apt-get install" in told
    assert "--gpus all" in told
    assert "dnf" not in told


@pytest.mark.parametrize(
    ("release", "system"),
    [
        ("ID=debian", "Debian, Ubuntu"),
        ('ID=linuxmint\nID_LIKE="ubuntu debian"', "Debian, Ubuntu"),
        ("ID=fedora", "Fedora"),
        ("ID=arch", "Arch"),
        ("ID=void", ""),
    ],
)
def test_the_system_is_known_by_its_release(
    release: str, system: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sys, "platform", "linux")
    monkeypatch.delenv("CI", raising=False)
    named = [name for name in install_hints.systems_here(release) if name != "Docker"]
    assert named == ([system] if system else [])


def test_a_system_that_is_not_known_gets_all_remedies(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(install_hints, "systems_here", lambda: ["hosted CI"])
    assert len(install_hints.remedies()) == len(install_hints.REMEDIES)


def test_every_device_of_egl_is_examined(monkeypatch: pytest.MonkeyPatch) -> None:
    def devices(route: str, device: int = 0) -> Examination:
        there = route == "egl" and device < 3
        found: Any = {"open": {"renderer": "toy"} if there else {"error": "none"}, "end": {}}
        return Examination(route, device, found, "")

    monkeypatch.setattr(doctor, "examine", devices)
    examined = [(e.route, e.device) for e in doctor.examine_all()]
    assert examined == [("egl", 0), ("egl", 1), ("egl", 2), ("window", 0), ("osmesa", 0)]


def test_report_says_what_a_dead_driver_had_shown(monkeypatch: pytest.MonkeyPatch) -> None:
    """The fragment pipeline is tried first: it may be what is left."""
    dead = dying([OPENED, RIGHT], "os.abort()")
    monkeypatch.setattr(doctor, "examine", lambda route, device=0: dead)
    text, works = report()
    assert works
    assert "fragment      a furnace is exact" in text
    assert "compute       no answer" in text
    assert "the driver crashed" in text
    assert "compute shaders fail: use --pipeline fragment" in text


def test_what_the_machine_lacks_is_listed(
    told: Callable[..., str], examined: list[Examination], monkeypatch: pytest.MonkeyPatch
) -> None:
    assert "Not available here" not in told()
    monkeypatch.setattr(doctor, "find_spec", lambda name: None if name == "glfw" else name)
    assert f"Not available here: the window: {install('view')}." in told().splitlines()
    for examination in examined:
        monkeypatch.delitem(examination.found, "compute", raising=False)
    (first, second) = json.loads(told(as_json=True))["lacks"]
    assert first.startswith("the window")
    assert second.startswith("light by layers")
    assert second.endswith("needs compute shaders, OpenGL 4.3")
