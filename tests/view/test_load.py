"""The load of the machine: frames, processors, and a GPU whose driver is played by a stand-in."""

import sys
from types import ModuleType
from typing import Any

import pytest

from glrt.process import load
from glrt.process.load import Load, LoadMeter, gpu_of, mean_of
from glrt.view.panels.plots import load_text

H100 = "NVIDIA H100 80GB HBM3/PCIe/SSE2"  # as OpenGL's driver gives it
SOFTWARE = "llvmpipe (LLVM 15.0.6, 256 bits)"


class NVMLError(Exception):
    """The error of the management library."""


def driver(monkeypatch: pytest.MonkeyPatch, *names: str | bytes, **broken: bool) -> list[float]:
    """Install a stand-in for NVIDIA's library; return the shares of its GPUs, in percent."""
    shares = [10.0 * number for number in range(len(names))]
    library: Any = ModuleType("pynvml")

    def fail_if(what: str) -> None:
        if broken.get(what):
            raise NVMLError(f"no {what}")

    library.NVMLError = NVMLError
    library.nvmlInit = lambda: fail_if("library")
    library.nvmlDeviceGetCount = lambda: len(names)
    library.nvmlDeviceGetHandleByIndex = lambda number: number
    library.nvmlDeviceGetName = lambda number: names[number]

    def rates(number: int) -> Any:
        fail_if("reading")
        return type("Rates", (), {"gpu": shares[number]})

    library.nvmlDeviceGetUtilizationRates = rates
    monkeypatch.setitem(sys.modules, "pynvml", library)
    return shares


class Clock:
    """Times that a test sets."""

    now = used = 0.0

    def meter(self, renderer: str = SOFTWARE) -> LoadMeter:
        return LoadMeter(renderer, 1.0, lambda: self.now, lambda: self.used, processors=4)


def test_the_gpu_of_the_renderer_is_read_among_several(monkeypatch: pytest.MonkeyPatch) -> None:
    shares = driver(monkeypatch, "NVIDIA T4", b"NVIDIA H100 80GB HBM3", "NVIDIA H100")
    gpu = gpu_of(H100)
    assert (gpu.read(), gpu.unknown) == (0.1, "")
    shares[1] = 88
    assert gpu.read() == 0.88
    assert gpu_of("T4/PCIe/SSE2").read() == 0.0, "old drivers leave the vendor out"


def test_an_unknown_share_has_a_reason(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "pynvml", None)  # importing it fails
    assert gpu_of(H100).unknown == load.MISSING
    assert gpu_of(SOFTWARE).unknown == "this driver reports no load"
    driver(monkeypatch, "NVIDIA H100 80GB HBM3", "NVIDIA H100 80GB HBM3")
    assert gpu_of(H100).unknown == "2 of 2 GPUs have the name of the renderer"
    driver(monkeypatch, "NVIDIA H100 80GB HBM3", library=True)
    assert gpu_of(H100).unknown == "NVIDIA's management library fails: no library"
    assert gpu_of(H100).read() is None


def test_a_reading_that_fails_is_none(monkeypatch: pytest.MonkeyPatch) -> None:
    driver(monkeypatch, "NVIDIA H100 80GB HBM3", reading=True)
    gpu = gpu_of(H100)
    assert (gpu.read(), gpu.unknown) == (None, "")


def test_a_period_counts_its_frames_and_processor_seconds() -> None:
    clock = Clock()
    meter = clock.meter()
    for clock.now in (0.25, 0.5, 0.75):
        assert meter.look() is None
    clock.now, clock.used = 2.0, 6.0
    assert meter.look() == Load(2.0, 4, 0.75, None)
    assert meter.last is not None
    assert meter.last.rate == 2.0
    clock.now = 2.5
    assert meter.look() is None
    clock.now = 3.0
    assert meter.look() == Load(1.0, 2, 0.0, None), "a period begins where the last one ended"


def test_the_mean_weighs_periods_by_their_seconds() -> None:
    loads = [Load(1.0, 10, 0.2, 0.5), Load(3.0, 60, 0.6, None), Load(1.0, 20, 0.2, 1.0)]
    mean = mean_of(loads)
    assert (mean.seconds, mean.frames, mean.gpu) == (5.0, 90, 0.75)
    assert mean.cpu == pytest.approx(0.44)
    assert mean_of(loads[1:2]).gpu is None


def test_the_window_tells_what_is_known(monkeypatch: pytest.MonkeyPatch) -> None:
    clock = Clock()
    driver(monkeypatch, "NVIDIA T4", "NVIDIA H100 80GB HBM3")
    meters = [clock.meter(), clock.meter(H100)]
    assert load_text(meters[0]) == "load not known yet"
    monkeypatch.setitem(sys.modules, "pynvml", None)
    meters.append(clock.meter(H100))
    clock.now, clock.used = 1.0, 2.0
    for meter in meters:
        meter.look()
    assert [load_text(meter) for meter in meters] == [
        "1 frames/s, 50 % of 4 processors",
        "1 frames/s, 50 % of 4 processors, 10 % of the GPU",
        f"1 frames/s, 50 % of 4 processors; GPU: {load.MISSING}",
    ]
