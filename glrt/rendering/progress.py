"""What a render tells of itself: samples, kernels, seconds."""

import moderngl

from glrt.gpu.glsl import Source
from glrt.rendering.device_scene import DeviceScene
from glrt.rendering.film import Film
from glrt.rendering.particle_tracer import Losses
from glrt.rendering.pass_film import Array
from glrt.rendering.pipelines import Tier
from glrt.rendering.probe_supply import ProbeSupply
from glrt.rendering.tracer import Tracer
from glrt.settings import Aov


class Progress:
    """How far a tracer is, and by what."""

    _tracer: Tracer

    @property
    def samples(self) -> int:
        """How many samples each pixel has."""
        return self.film.samples

    @property
    def shown(self) -> tuple[int, int]:
        """Samples of each pixel of the picture, and of its AOVs."""
        return self.samples, self._tracer.aovs.samples

    @property
    def work(self) -> float:
        """Samples a pixel, and the share that is done of those in the frame that has begun."""
        return self.samples + self._tracer.switch.schedule.begun

    @property
    def film(self) -> Film:
        """What has been gathered."""
        return self._tracer.film

    @property
    def device_scene(self) -> DeviceScene:
        """The scene in the driver's memory, until the next edit: for passes beside the picture."""
        return self._tracer.device_scene

    @property
    def probes(self) -> ProbeSupply:
        """What lights the picture indirectly, where the method has probes."""
        return self._tracer.probes

    @property
    def tier(self) -> Tier:
        """Where the kernel that stays through edits finds its shapes."""
        return self._tracer.device_scene.tier

    @property
    def shaders(self) -> list[Source]:
        """The shaders of that kernel, as the driver got them; the last one traces paths."""
        return self._tracer.device_scene.shaders

    @property
    def most_samples(self) -> int:
        """How many samples a dispatch may take."""
        return self._tracer.most_samples

    @property
    def seconds(self) -> dict[str, float]:
        """What it took to `build` trees, to `pack` the scene, and to `compile` kernels."""
        compiled = self._tracer.switch.compile_seconds + self._tracer.aovs.compile_seconds
        return {**self._tracer.device_scene.seconds, "compile": compiled}

    def aov_mean(self, aov: Aov) -> moderngl.Texture | None:
        """An AOV so far, for the window; None if it is not gathered or empty."""
        return self._tracer.aovs.mean(aov)

    def aov_pixel(self, aov: Aov, x: int, y: int) -> Array | None:
        """The mean of an AOV in one pixel and its standard error, (2, 3); None if it has none."""
        return self._tracer.aovs.pixel(aov, x, y)

    @property
    def is_baked(self) -> bool:
        """Whether the kernel that runs has the shapes written into it."""
        return self.tier == "baked" or self._tracer.switch.uses_fast_kernel

    @property
    def lost_particles(self) -> Losses:
        """Of the particles that were linked to the camera."""
        return self._tracer.lost_particles
