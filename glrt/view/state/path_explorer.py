"""Paths of one pixel, requested in the window and traced again by the recording kernel."""

import time
from collections.abc import Iterator
from contextlib import ExitStack
from dataclasses import replace

from glrt.gpu.context import Context
from glrt.image.recipe import Recipe
from glrt.rendering.paths.replay import Array, PathReplay, arrived, path_replay
from glrt.rendering.paths.values import Path, PixelPaths
from glrt.scene.nameless import less_names
from glrt.scene.scene import Scene
from glrt.settings import Caustics, Settings, settings_for

FOLLOWED = 64  # samples at most whose particles are followed
SECONDS = 0.1  # of a frame for following particles
MOST = 4096  # samples of a pixel that are traced again
SHOWN = 8  # the brightest of them are listed
ANNOUNCED = 2  # frames that announce a compilation before it blocks them
Asked = tuple[Scene, Settings, tuple[int, int], int]


class PathExplorer:
    """Paths of at most one pixel, by the scene and settings at the time of the request."""

    def __init__(self, context: Context) -> None:
        """Compile nothing before a pixel is requested."""
        self._context = context
        self._replay: PathReplay | None = None
        self._recipe: Recipe | None = None
        self._held = ExitStack()
        self._asked: Asked | None = None
        self._frames = 0
        self._following: Iterator[Array] | None = None
        self._followed: list[Array] = []  # light of the particles of each sample
        self.is_choosing = False  # whether a click in the picture asks for its pixel
        self.with_particles = False  # whether particles are traced even if the picture has none
        self.found: PixelPaths | None = None
        self.shown: Path | None = None  # the path on the screen
        self.is_new = False  # whether the panel has not shown these paths yet

    @property
    def is_waiting(self) -> bool:
        """Whether a requested pixel or its particles are not traced yet."""
        return self._asked is not None or self._following is not None

    @property
    def busy(self) -> str:
        """Notice on what the next frame waits for; "" for nothing."""
        if self._following:
            return f"Following particles: {len(self._followed)} of {self._wanted} samples"
        is_new = self._asked and not self._is_open(*self._asked[:2])
        return "Compiling the kernel that records paths" if is_new else ""

    def ask(self, scene: Scene, settings: Settings, pixel: tuple[int, int], samples: int) -> None:
        """Request samples of a pixel of the full frame; one of the next frames traces them."""
        how: Caustics = "on" if self.with_particles else settings.caustics
        plain = settings_for(settings, aov=(), caustics=how, samples=1)
        self._asked, self._frames = (scene, plain, pixel, min(max(samples, 1), MOST)), 0
        self._following = None

    def advance(self) -> bool:
        """Do a frame's work, if any; returns whether. GlrtError if paths cannot be recorded."""
        if not self._asked:
            return self._follow()
        self._frames += 1
        if self.busy and self._frames <= ANNOUNCED:
            return True
        (scene, settings, pixel, samples), self._asked = self._asked, None
        replay, recipe = self._opened(scene, settings)
        radiances = replay.radiances(pixel, samples)
        taken = settings_for(settings, samples=samples)
        recipe = recipe.model_copy(update={"settings": taken, "samples": samples})
        found = PixelPaths(recipe, pixel, radiances, ())
        paths = replay.paths(pixel, found.brightest(SHOWN) or [0])
        self.found, self.shown = PixelPaths(recipe, pixel, radiances, paths), paths[0]
        self.is_new = True
        if settings.caustics == "on":
            self._following, self._followed = replay.arriving(pixel, self._wanted), []
        return True

    @property
    def _wanted(self) -> int:
        """Number of samples whose particles are followed: whole observations, as in a render."""
        assert self.found
        settings = self.found.recipe.settings
        whole = settings.block * -(-settings.samples // settings.block)
        return min(whole, max(FOLLOWED, settings.block))

    def _follow(self) -> bool:
        """Follow particles for a frame, at the end trace the brightest; returns whether it did."""
        if not self._following or not self.found or not self._replay:
            return False
        start = time.perf_counter()
        while time.perf_counter() - start < SECONDS:
            lights = next(self._following, None)
            if lights is None:
                self._following = None
                self._list_particles(self._replay, self.found)
                break
            self._followed.append(lights)
        return True

    def _list_particles(self, replay: PathReplay, found: PixelPaths) -> None:
        there = arrived(self._followed)
        paths = (replay.particle_path(found.pixel, *name) for name in there.brightest(SHOWN))
        there = replace(there, paths=tuple(path for path in paths if path))
        self.found = replace(found, particles=there)

    def show(self, sample: int) -> None:
        """Show the path of a sample by its number."""
        if self.found and self._replay and 0 <= sample < len(self.found.radiances):
            known = {path.sample: path for path in self.found.paths}
            (self.shown,) = (
                (known[sample],)
                if sample in known
                else self._replay.paths(self.found.pixel, [sample])
            )

    def is_of(self, scene: Scene) -> bool:
        """Whether the paths belong to the scene as it is now, whatever its camera."""
        if not self.found:
            return False
        asked, now = less_names(self.found.recipe.scene, scene)
        parts = ("objects", "materials", "background", "sun", "lights")
        return all(getattr(asked, part) == getattr(now, part) for part in parts)

    def forget(self) -> None:
        """Discard all paths and requests, and stop choosing pixels."""
        self.found = self.shown = self._asked = self._following = None
        self.is_choosing = False

    def release(self) -> None:
        """Release all OpenGL objects."""
        self.forget()
        self._held.close()
        self._replay = self._recipe = None

    def _is_open(self, scene: Scene, settings: Settings) -> bool:
        is_there = self._recipe and self._replay
        return bool(
            is_there
            and self._recipe
            and self._recipe.scene is scene
            and self._recipe.settings == settings
        )

    def _opened(self, scene: Scene, settings: Settings) -> tuple[PathReplay, Recipe]:
        if not self._is_open(scene, settings):
            self._held.close()
            self._replay = self._recipe = None
            opened = path_replay(scene, settings, self._context, "generic", "moved")
            self._replay, self._recipe = self._held.enter_context(opened)
        assert self._replay
        assert self._recipe
        return self._replay, self._recipe
