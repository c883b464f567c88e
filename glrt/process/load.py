"""The load of the machine by frames: frames a second, share of the processors, share of the GPU.

The share of the GPU is the time in which any program ran on it, over the last sixth of a second to
a second, as NVIDIA's management library (NVML, nvmlDeviceGetUtilizationRates) reports it. Python
reads it by the package nvidia-ml-py, the extra `gpu`.
"""

import os
import time
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

from glrt.core.install import install

MISSING = f"nvidia-ml-py is not installed: {install('gpu')}"
_VENDOR = "NVIDIA "  # before the names of GPUs, except in old drivers
_ENDING = "/SSE2"  # of the names that NVIDIA's OpenGL driver gives


class Load(NamedTuple):
    """Means over a period."""

    seconds: float
    frames: int
    cpu: float  # share of all processors that this process used, 0 to 1
    gpu: float | None  # share of the GPU that renders, 0 to 1; None where it is not known

    @property
    def rate(self) -> float:
        """Frames a second."""
        return self.frames / self.seconds


class Gpu(NamedTuple):
    """The GPU that renders: how to read its share, or why that is not known."""

    read: Callable[[], float | None]
    unknown: str = ""


class LoadMeter:
    """Measures the load over periods; `look` is to be called once a frame."""

    def __init__(
        self,
        renderer: str,
        period: float = 1.0,
        clock: Callable[[], float] = time.perf_counter,
        used: Callable[[], float] = time.process_time,
        processors: int | None = None,
    ) -> None:
        """`renderer` is the name that the OpenGL driver gives; `period` is in seconds.

        `used` returns the processor seconds of this process, of all its threads.
        """
        self.gpu = gpu_of(renderer)
        self.processors = processors or os.cpu_count() or 1
        self._period, self._clock, self._used = period, clock, used
        self._begin()
        self.last: Load | None = None  # of the last whole period

    def _begin(self) -> None:
        self._frames, self._start, self._start_used = 0, self._clock(), self._used()

    def look(self) -> Load | None:
        """Count a frame; return the load of a period if one ends with it, else None."""
        self._frames += 1
        seconds = self._clock() - self._start
        if seconds < self._period:
            return None
        share = (self._used() - self._start_used) / (seconds * self.processors)
        self.last = Load(seconds, self._frames, share, self.gpu.read())
        self._begin()
        return self.last


def mean_of(loads: Sequence[Load]) -> Load:
    """The load over several periods; each counts by its seconds."""
    seconds = sum(load.seconds for load in loads)
    known = [load for load in loads if load.gpu is not None]
    gpu = sum(it.gpu * it.seconds for it in known if it.gpu is not None)
    return Load(
        seconds,
        sum(load.frames for load in loads),
        sum(load.cpu * load.seconds for load in loads) / seconds,
        gpu / sum(load.seconds for load in known) if known else None,
    )


def gpu_of(renderer: str) -> Gpu:
    """Find the GPU of this name that the OpenGL driver gives, as "NVIDIA H100 PCIe/PCIe/SSE2"."""
    if not renderer.startswith(_VENDOR) and not renderer.endswith(_ENDING):
        return _unknown("this driver reports no load")
    try:
        import pynvml
    except ImportError:
        return _unknown(MISSING)
    try:
        pynvml.nvmlInit()
        count = pynvml.nvmlDeviceGetCount()
        handles = [pynvml.nvmlDeviceGetHandleByIndex(number) for number in range(count)]
        named = [it for it in handles if _is_named(_text(pynvml.nvmlDeviceGetName(it)), renderer)]
    except pynvml.NVMLError as error:
        return _unknown(f"NVIDIA's management library fails: {error}")
    if len(named) != 1:
        return _unknown(f"{len(named)} of {count} GPUs have the name of the renderer")
    return Gpu(lambda: _share(pynvml, named[0]))


def _unknown(reason: str) -> Gpu:
    return Gpu(lambda: None, reason)


def _share(pynvml: Any, handle: Any) -> float | None:
    try:
        return float(pynvml.nvmlDeviceGetUtilizationRates(handle).gpu) / 100
    except pynvml.NVMLError:
        return None


def _is_named(name: str, renderer: str) -> bool:
    """Whether OpenGL's name is that of a GPU: the bus and the instruction set follow in it."""
    return renderer.partition("/")[0].removeprefix(_VENDOR) == name.removeprefix(_VENDOR)


def _text(name: str | bytes) -> str:
    return name.decode() if isinstance(name, bytes) else name
