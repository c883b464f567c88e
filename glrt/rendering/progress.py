"""Read-only properties of a render: samples, pixels, kernels, seconds."""

import numpy as np

from glrt.gpu.context import Context
from glrt.gpu.glsl import Source
from glrt.plan.plan import Weights
from glrt.rendering.aov_tracer import AovMean
from glrt.rendering.device_scene import DeviceScene
from glrt.rendering.film import Film
from glrt.rendering.layer_weights import Reading, mixed, read_row
from glrt.rendering.particle_tracer import Losses
from glrt.rendering.pass_film import Array
from glrt.rendering.pipelines import Tier
from glrt.rendering.probe_supply import ProbeSupply
from glrt.rendering.tracer import Tracer
from glrt.settings import Aov, Settings


class Progress:
    """Read-only progress of a render: its samples, pixels, kernels and seconds."""

    context: Context
    settings: Settings
    _tracer: Tracer

    @property
    def size(self) -> tuple[int, int]:
        """Width and height of the picture or of the crop, in pixels."""
        return self.settings.size

    def lacks(self, samples: int) -> bool:
        """Whether the picture has fewer samples, or its particles or AOVs lag behind it."""
        return self.samples < samples or self._tracer.is_behind

    def nonfinite(self) -> int:
        """Number of samples and particles that were dropped because they were not finite."""
        with self.context.gl:
            return self.film.dropped() + self.lost_particles.refused

    @property
    def samples(self) -> int:
        """Samples per pixel so far."""
        return self.film.samples

    @property
    def next_sample(self) -> int:
        """The number of the sample that is next: of AOVs that lag behind, or of the picture."""
        aovs = self._tracer.aovs
        lags = aovs.is_behind(self.samples)
        return self.film.first_sample + (aovs.samples if lags else self.samples)

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
        """Tier of the kernel that survives edits: a name of `pipelines.TIERS`."""
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
    def running_tier(self) -> Tier:
        """Tier of the running kernel, which may be faster than the one that survives edits."""
        return self._tracer.switch.fast or self.tier

    @property
    def is_baked(self) -> bool:
        """Whether the running kernel has the shapes written into it."""
        return self.running_tier in ("baked", "complete")

    @property
    def lost_particles(self) -> Losses:
        """Losses among the particles that were linked to the camera."""
        particles = self._tracer.particles
        return particles.losses if particles else Losses(0, 0)

    def reading(self, weights: Weights, x: int, y: int) -> Reading:
        """Reading of the pixel in column x, row y, (0, 0) upper left; needs a current context."""
        row, radiance, error = read_row(self.film, weights, y)
        radiance, error, _ = self._tracer.with_particles(radiance, error, weights, y)
        taken = np.broadcast_to(self.film.taken(slice(y, y + 1)), row.dropped.shape)
        finite = int(taken[0, x] - row.dropped[0, x])
        return Reading(radiance[0, x], error[0, x], finite)

    def picture(self, weights: Weights) -> tuple[Array, Array]:
        """Weighted radiance and its standard error, (H, W, 3) float32; needs a current context."""
        mean, noise, _ = mixed(self.film, weights)
        radiance, stderr, _ = self._tracer.with_particles(mean, noise, weights)
        return radiance, stderr
