"""Mitsuba as a renderer of glrt's scenes. It runs in programs of its own: see `__init__`."""

import ctypes
import importlib
import os
from typing import Any

import numpy as np

from glrt.core.errors import UsageError
from glrt.core.version import VERSION
from glrt.image.image import Image
from glrt.image.recipe import Recipe
from glrt.scene.scene import Scene
from glrt.settings import Settings, settings_for
from tests.mitsuba.convert import BLOCK, Liberties, convert

LLVM = "libLLVM.so.19.1"  # with 15 and 16, Mitsuba ends the process; 14 it refuses
LLVM_PACKAGE = "libllvm19"

BATCHES = 64  # at most: their spread gives the error
EXACT = Liberties()
MOST_PATHS = 1 << 22  # at a time, which bounds memory; 7 % slower with a quarter of them

Pixels = np.ndarray[Any, np.dtype[np.float32]]


def load_mitsuba(variant: str = "auto") -> Any:
    """The module with its variant set: `llvm`, `scalar`, or `auto`, LLVM where it is there.

    Raises UsageError if Mitsuba or its LLVM is not installed.
    """
    if variant == "auto":
        variant = "llvm" if _has_llvm() else "scalar"
    if variant == "llvm" and not _has_llvm():
        raise UsageError(f"Mitsuba's LLVM mode needs the system package {LLVM_PACKAGE}.")
    os.environ["DRJIT_LIBLLVM_PATH"] = LLVM
    try:
        mi = importlib.import_module("mitsuba")
    except ImportError:
        message = "Mitsuba is not installed: type pip install 'glrt[mitsuba]', or make bench."
        raise UsageError(message) from None
    mi.set_variant({"llvm": "llvm_ad_rgb", "scalar": "scalar_rgb"}[variant])
    return mi


def _has_llvm() -> bool:
    try:
        ctypes.CDLL(LLVM)
    except OSError:
        return False
    return True


def name_of(mi: Any) -> str:
    """The renderer's name in a recipe."""
    return f"Mitsuba {mi.__version__}, {mi.variant()}"


class Engine:
    """A scene ready to be rendered many times; settings are those of glrt."""

    def __init__(
        self,
        mi: Any,
        scene: Scene,
        settings: Settings,
        liberties: Liberties = EXACT,
        file: str | None = None,
    ) -> None:
        """Convert the scene and load it, or load the file to which `glrt export` wrote it.

        Raises SceneError if Mitsuba cannot show it.
        """
        self._block = 1 if liberties.sampler == "independent" else BLOCK
        self._mi = mi
        self.name = name_of(mi)
        self.scene = scene
        self.settings = settings_for(settings, method="mis", sampler="independent")
        if file:
            self._loaded = mi.load_file(file)
        else:
            self._loaded = mi.load_dict(convert(mi, scene, settings, liberties))

    def pixels(self, samples: int, seed: int) -> Pixels:
        """The mean of `samples` samples, (H, W, 3), row 0 on top. Equal seeds, equal samples."""
        return np.array(self._mi.render(self._loaded, spp=samples, seed=seed), dtype=np.float32)

    def image(self, samples: int, seed: int = 0, batches: int = BATCHES) -> Image:
        """A picture with its standard errors, from the spread of batches.

        With another sampler than the independent one, batches are blocks of BLOCK samples;
        UsageError if `samples` is no multiple of it.
        """
        sizes = _sizes(samples, batches, self.settings.width * self.settings.height)
        if self._block > 1:
            sizes = _blocks(samples)
        total, squares = np.zeros((2, self.settings.height, self.settings.width, 3))
        for index, size in enumerate(sizes):
            pixels = self.pixels(size, _seed(seed, index)).astype(float)
            total += size * pixels
            squares += size * np.square(pixels)
        mean = total / samples
        spread = np.maximum(squares / samples - np.square(mean), 0)
        with np.errstate(divide="ignore", invalid="ignore"):
            stderr = np.sqrt(spread / (len(sizes) - 1))
        pair = mean.astype(np.float32), stderr.astype(np.float32)
        return Image(*pair, samples, self._recipe(samples, seed))

    def _recipe(self, samples: int, seed: int) -> Recipe:
        return Recipe(
            scene=self.scene,
            settings=settings_for(self.settings, samples=samples, seed=seed),
            samples=samples,
            version=VERSION,
            renderer=self.name,
        )


def _sizes(samples: int, batches: int, pixels: int) -> list[int]:
    """Samples of each batch, as equal as can be; of more batches if memory asks for it."""
    least = -(-samples * pixels // MOST_PATHS)
    count = min(samples, max(batches, least))
    return [(index + 1) * samples // count - index * samples // count for index in range(count)]


def _blocks(samples: int) -> list[int]:
    if samples % BLOCK:
        raise UsageError(f"this sampler of Mitsuba takes multiples of {BLOCK} samples.")
    return [BLOCK] * (samples // BLOCK)


def _seed(seed: int, batch: int) -> int:
    return (seed * 0x10001 + batch) % (1 << 32)
