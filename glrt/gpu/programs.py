"""The programs of a context, by their source: each is compiled once, and shared by its users."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from glrt.gpu.glsl import Source
from glrt.gpu.program import FragmentKernel, Kernel
from glrt.gpu.raster_kernel import RasterKernel

AnyKernel = Kernel | FragmentKernel | RasterKernel
IDLE = 8  # unused programs that are kept


@dataclass
class _Held:
    """A program, and the number of its users."""

    kernel: AnyKernel
    users: int = 0


class Programs:
    """A cache of compiled programs: unused ones are freed, the least recently used first."""

    def __init__(self) -> None:
        """Create an empty cache."""
        self._held: dict[tuple[object, ...], _Held] = {}  # most recently used last

    def take(self, shaders: Sequence[Source], compiled: Callable[[], AnyKernel]) -> AnyKernel:
        """Return the program of these shaders; `compiled` makes it if it is not in the cache.

        Each call needs a `give_back` when its user is done.
        """
        key = _key(shaders)
        held = self._held.pop(key, None) or _Held(compiled())
        held.users += 1
        self._held[key] = held
        self._free_idle()
        return held.kernel

    def has(self, shaders: Sequence[Source]) -> bool:
        """Whether the program of these shaders is in the cache."""
        return _key(shaders) in self._held

    def give_back(self, kernel: AnyKernel) -> None:
        """Count one user less; the program stays in the cache for a while."""
        held = next(held for held in self._held.values() if held.kernel is kernel)
        held.users -= 1
        held.kernel.rest()
        self._free_idle()

    def _free_idle(self) -> None:
        idle = [key for key, held in self._held.items() if not held.users]
        for key in idle[: max(len(idle) - IDLE, 0)]:
            self._held.pop(key).kernel.release()


def _key(shaders: Sequence[Source]) -> tuple[object, ...]:
    return tuple(shader.key for shader in shaders)
