"""The thesis's Pipeline: what it holds, and what happens in a frame."""

from typing import Any

import numpy as np

from glrt.core.errors import SceneError
from glrt.core.version import VERSION
from glrt.image.image import Image
from glrt.image.recipe import Recipe
from glrt.rendering.film import Exposure, standard_error
from glrt.scene.scene import Scene
from glrt.settings import Settings, settings_for
from tests.wgsl.device import describe
from tests.wgsl.program import RayTracer
from tests.wgsl.resources import RandomTexture, SceneBuffers, color_texture, read_texture

FRAMES_IN_FLIGHT = 8
LOOP_LIMIT = 60_000  # llvmpipe ends all loops of an invocation silently after 65,535 rounds


def naive(scene: Scene, settings: Settings | None = None, **overrides: Any) -> Settings:
    """The settings, by default the scene's, as far as the thesis's tracer has them.

    Lamps are found by scattering alone, no roulette ends a path, the frame is rendered whole.
    """
    fixed = {"method": "naive", "roulette": False, "sampler": "independent", "crop": None}
    return settings_for(settings or scene.render, **overrides, **fixed)


class Tracer:
    """A scene, gathered at one sample a frame."""

    def __init__(self, program: RayTracer, scene: Scene, settings: Settings) -> None:
        """Fill buffers and textures; `settings` are those of `naive`.

        Raises SceneError for a scene on which a software driver would end its loops early.
        """
        _refuse_what_never_ends(scene, settings)
        self.scene, self.settings, self.samples = scene, settings, 0
        self._program = program
        self._buffers = SceneBuffers(program.device, scene, settings)
        self.random = RandomTexture(program.device, settings)
        self._pairs = [[self._color() for _ in ("mean", "variance")] for _ in range(2)]
        self._scene = program.bind(0, self._buffers.in_order)
        source, target = self._pairs
        self._groups = [self._bound(source, target), self._bound(target, source)]

    def render(self, samples: int | None = None) -> "Tracer":
        """Frames until each pixel has `samples`, by default the settings'."""
        while self.samples < (samples or self.settings.samples):
            self.frame()
            if self.samples % FRAMES_IN_FLIGHT == 0:
                self._buffers.wait()
        self._buffers.wait()
        return self

    def frame(self) -> None:
        """Swap, trace, count, refresh the random texture; there is no screen to show it on."""
        self.swap()
        width, height = self.settings.width, self.settings.height
        self._program.run([self._scene, self._groups[0]], width, height)
        self.samples += 1
        self._buffers.count(self.samples)
        self.refresh()

    def swap(self) -> None:
        """Source and target change places."""
        self._pairs.reverse()
        self._groups.reverse()

    def refresh(self) -> None:
        """Other numbers for the next frame."""
        self.random.refresh(self.samples)

    @property
    def picture(self) -> Any:
        """The texture with the mean so far: the target of the last frame."""
        return self._pairs[1][0]

    def read(self) -> Exposure:
        """Mean and variance so far."""
        mean, variance = (self._read(texture) for texture in self._pairs[1])
        whole = mean[..., :3], variance[..., :3], mean[..., 3], variance[..., 3]
        begun = np.zeros_like(whole[0]), np.zeros_like(whole[2])  # a sample is an observation
        no_layers = np.empty((2, 0, *mean.shape), np.float32)
        return Exposure(*(part.copy() for part in (*whole, *begun, no_layers)))

    def nonfinite(self) -> int:
        """How many samples were dropped because they were not finite."""
        return int(self.read().dropped.sum())

    def image(self) -> Image:
        """The picture so far, with its standard error and its recipe."""
        film = self.read()
        recipe = Recipe(
            scene=self.scene,
            settings=self.settings,
            samples=self.samples,
            version=VERSION,
            renderer=f"WGSL, {describe(self._program.device)}",
        )
        return Image(film.mean, standard_error(film), self.samples, recipe)

    def _color(self) -> Any:
        size = self.settings.width, self.settings.height
        return color_texture(self._program.device, size, self._program.texel)

    def _bound(self, source: list[Any], target: list[Any]) -> Any:
        textures = [self.random.texture, *source, *target]
        return self._program.bind(1, [texture.create_view() for texture in textures])

    def _read(self, texture: Any) -> np.ndarray[Any, Any]:
        data = read_texture(self._program.device, texture, 16)
        return np.frombuffer(data, np.float32).reshape(self.settings.height, -1, 4)


def _refuse_what_never_ends(scene: Scene, settings: Settings) -> None:
    rounds = (settings.bounces + 1) * (1 + len(scene.objects))
    if rounds > LOOP_LIMIT:
        raise SceneError(
            f"the WGSL version has no tree over the shapes: a sample would take {rounds} rounds of "
            f"its loops, above {LOOP_LIMIT}. Use fewer objects or fewer bounces."
        )
