"""Read-only properties of a render: samples, kernels, seconds."""

from glrt.gpu.glsl import Source
from glrt.rendering.aov_tracer import AovMean
from glrt.rendering.device_scene import DeviceScene
from glrt.rendering.film import Film
from glrt.rendering.particle_tracer import Losses
from glrt.rendering.pass_film import Array
from glrt.rendering.pipelines import Tier
from glrt.rendering.probe_supply import ProbeSupply
from glrt.rendering.tracer import Tracer
from glrt.settings import Aov


class Progress:
    """Read-only progress of a render: its samples, kernels and seconds."""

    _tracer: Tracer

    @property
    def samples(self) -> int:
        """Samples per pixel so far."""
        return self.film.samples

    @property
    def shown(self) -> tuple[int, int]:
        """Samples per pixel of the picture, and of its AOVs."""
        return self.samples, self._tracer.aovs.samples

    @property
    def work(self) -> float:
        """Samples per pixel, including the completed share of the current frame."""
        return self.samples + self._tracer.switch.schedule.begun

    @property
    def film(self) -> Film:
        """The film, which holds mean and variance of each pixel."""
        return self._tracer.film

    @property
    def device_scene(self) -> DeviceScene:
        """The scene in driver memory until the next edit, for other passes over the picture."""
        return self._tracer.device_scene

    @property
    def probes(self) -> ProbeSupply:
        """The probes that light the picture indirectly, if the method has any."""
        return self._tracer.probes

    @property
    def tier(self) -> Tier:
        """Tier of the kernel that survives edits: "baked" has shapes as constants, or "generic"."""
        return self._tracer.device_scene.tier

    @property
    def shaders(self) -> list[Source]:
        """Shader sources of the kernel that survives edits; the last one traces paths."""
        return self._tracer.device_scene.shaders

    @property
    def most_samples(self) -> int:
        """The most samples per pixel that one dispatch may take."""
        return self._tracer.most_samples

    @property
    def seconds(self) -> dict[str, float]:
        """Seconds to `build` trees, to `pack` the scene, and to `compile` kernels."""
        compiled = self._tracer.switch.compile_seconds + self._tracer.aovs.compile_seconds
        return {**self._tracer.device_scene.seconds, "compile": compiled}

    def aov_mean(self, aov: Aov) -> AovMean | None:
        """An AOV's mean so far; None if it is not gathered or has no samples."""
        return self._tracer.aovs.mean(aov)

    def aov_pixel(self, aov: Aov, x: int, y: int) -> Array | None:
        """The mean of an AOV in one pixel and its standard error, (2, 3); None without samples."""
        return self._tracer.aovs.pixel(aov, x, y)

    @property
    def is_baked(self) -> bool:
        """Whether the running kernel has the shapes written into it."""
        return self.tier == "baked" or self._tracer.switch.uses_fast_kernel

    @property
    def lost_particles(self) -> Losses:
        """Losses among the particles that were linked to the camera."""
        particles = self._tracer.particles
        return particles.losses if particles else Losses(0, 0)
