"""Particles on the driver: a film of the light that they bring, gathered as the picture grows.

Each observation of the picture has one observation of particles. Work groups of particles add
their light in fixed point. Then the film gets the sums, as one value per pixel.
"""

import time
from contextlib import ExitStack
from dataclasses import dataclass
from typing import NamedTuple

import moderngl
import numpy as np

from glrt.core.errors import RenderError
from glrt.gpu.context import Context
from glrt.gpu.driver_checks import usable_rounds
from glrt.gpu.program import tile_count
from glrt.gpu.programs import AnyKernel
from glrt.image.particle_film import ParticleFilm, observations_of, summed
from glrt.plan.particles import particle_groups
from glrt.plan.plan import Plan, Weights, are_trivial
from glrt.rendering.device_scene import DeviceScene
from glrt.rendering.kernel_switch import ready
from glrt.rendering.pass_film import Array, PassFilm
from glrt.rendering.passes import PARTICLES, SPLATS
from glrt.rendering.schedule import (
    DispatchPolicy,
    DispatchRange,
    Schedule,
    iterations_per_sample,
    rounds_for_particles,
    whole_frame,
)

HEAD = 8  # bytes of the block before its words: two counts
PIXEL = 24  # bytes of a pixel: two words of each channel


class Losses(NamedTuple):
    """Numbers of particles whose light is missing from the film, at least in part."""

    clipped: int  # brought more light to a pixel than its sum takes at once
    refused: int  # brought light that is not finite


@dataclass
class _Numbered:
    """The particle film as a dispatch sees it, with the number of its first sample."""

    film: PassFilm
    next_sample: int
    samples: int = 1  # whatever the film holds, particles do not read it

    def images(self) -> dict[str, moderngl.Texture]:
        return self.film.images()


class ParticleTracer:
    """Gathers the light of a plan's particles: in total, and for each layer."""

    def __init__(self, context: Context, plan: Plan, scene: DeviceScene) -> None:
        """Allocate a film and a buffer of sums, and compile the kernels.

        Raises RenderError if the driver has no room for them.
        """
        self._context, self._plan, self._scene = context, plan, scene
        self._block, size = plan.settings.division.points, plan.settings.size
        self._groups, self._tiles = particle_groups(plan.settings), tile_count(*size)
        self._rounds, most = _limits(context, plan)
        rounds = iterations_per_sample(plan) + rounds_for_particles(plan)
        self._schedule = Schedule(self._groups, most, rounds)
        self._begun = 0  # samples of the incomplete observation
        self._is_cleared = False  # whether the sums were cleared for this observation
        self._lost = Losses(0, 0)
        start = time.perf_counter()
        with ExitStack() as refused:
            what = f"the particles of {size[0]} x {size[1]} pixels"
            wide = size[0] * (plan.layers + 1), size[1]
            self.film = PassFilm(context.gl, what, dict.fromkeys(PARTICLES.outputs, wide))
            refused.callback(self.film.release)
            words = PIXEL * size[0] * size[1] * max(plan.layers, 1)
            self._sums = _block_of_sums(context, what, HEAD + words)
            refused.callback(self._sums.release)
            give_back = context.programs.give_back
            self._kernel: AnyKernel = ready(context, scene.shaders_of(PARTICLES), self._dispatch)
            refused.callback(give_back, self._kernel)
            self._fold: AnyKernel = ready(context, scene.shaders_of(SPLATS), self._dispatch_fold)
            self._schedule.follow(self._kernel.pace)
            refused.pop_all()
        self.compile_seconds = time.perf_counter() - start
        self.restart(plan.first_sample)

    def restart(self, first_sample: int) -> None:
        """Discard all light, and begin at sample number `first_sample`."""
        self.film.restart(first_sample)
        self._lost = Losses(0, 0)
        self._begin()

    def is_behind(self, samples: int) -> bool:
        """Whether a picture of `samples` per pixel lacks an observation of particles."""
        return self.film.samples < observations_of(samples, self._block)

    def work_on(self, policy: DispatchPolicy, seconds: float) -> None:
        """Run one dispatch of the current observation, in about `seconds`."""
        if not self._is_cleared:
            self._sums.clear()
            self._is_cleared = True
        missing = self._block - self._begun
        part = self._schedule.next_dispatch(missing, min(seconds, policy.limit / 2), self._begun)
        start = time.perf_counter()
        self._dispatch(self._kernel, part)
        self._context.finish()
        taken = time.perf_counter() - start
        if self._rounds is not None and self._scene.lost_any() and part.samples > 1:
            self._begin(part.samples // 2)
        elif self._schedule.record(part, taken):
            self._begun += part.samples
        if self._begun == self._block:
            self._end()

    def added_to(
        self, radiance: Array, stderr: Array, weights: Weights, first: int = 0
    ) -> tuple[Array, Array, ParticleFilm]:
        """Rows of a picture plus the light of particles, from row `first` on, under weights.

        Returns radiance and standard error, (H, W, 3) float32 each, and the two films separately.
        Layers come from different particles, so their variances add.
        """
        height, width, _ = radiance.shape
        read = (self.film.read_output(name, first, first + height) for name in PARTICLES.outputs)
        mean, variance = (
            rows[..., :3].reshape(height, self._plan.layers + 1, width, 3) for rows in read
        )
        is_whole = are_trivial(weights) or not self._plan.layers
        layers = slice(0, 1) if is_whole else slice(1, None)
        factors = np.array(weights[:1] if is_whole else weights, np.float32)[:, None]
        film = ParticleFilm(
            radiance,
            (mean[:, layers] * factors).sum(axis=1, dtype=np.float32),
            (variance[:, layers] * factors**2).sum(axis=1, dtype=np.float32),
        )
        return *summed(film, stderr, self.film.samples), film

    def resume(self, samples: int, film: ParticleFilm) -> None:
        """Continue from the particle film of a picture with `samples` per pixel."""
        self._begin()
        self.film.samples = observations_of(samples, self._block)
        count = np.full((*film.mean.shape[:2], 1), self.film.samples, np.float32)
        for name, rows in zip(PARTICLES.outputs, (film.mean, film.variance), strict=True):
            texels = np.concatenate([rows, count], axis=2)
            self.film.sources[name].write(np.ascontiguousarray(texels, np.float32))

    @property
    def losses(self) -> Losses:
        """Losses among the particles that were linked to the camera, since the last restart."""
        return self._lost

    def release(self) -> None:
        """Release all OpenGL resources."""
        self.film.release()
        self._sums.release()
        for kernel in (self._kernel, self._fold):
            self._context.programs.give_back(kernel)

    def _begin(self, most_samples: int | None = None) -> None:
        """Begin the current observation again; `most_samples` limits its dispatches."""
        self._begun, self._is_cleared = 0, False
        self._schedule.drop() if most_samples is None else self._schedule.limit(most_samples)

    def _end(self) -> None:
        """Add the complete observation to the film, and count its losses."""
        for part in whole_frame(self._block, self._tiles):
            self._dispatch_fold(self._fold, part)
        self.film.advance(1)
        self._begun = 0
        counts = np.frombuffer(self._sums.read(HEAD), np.uint32)
        self._sums.write(bytes(HEAD))
        self._lost = Losses(*(old + int(new) for old, new in zip(self._lost, counts, strict=True)))

    def _dispatch(self, kernel: AnyKernel, part: DispatchRange) -> None:
        film = self.film
        first = film.first_sample + film.samples * self._block + self._begun
        groups, own = self._groups, {"Splats": self._sums}
        self._scene.dispatch(kernel, _Numbered(film, first), self._plan, part, groups, own)

    def _dispatch_fold(self, kernel: AnyKernel, part: DispatchRange) -> None:
        own = {"Splats": self._sums}
        self._scene.dispatch(kernel, self.film, self._plan, part, self._tiles, own)


def particles_for(context: Context, plan: Plan, scene: DeviceScene) -> ParticleTracer | None:
    """The tracer for the particles of a plan; None if caustics are off."""
    return None if plan.settings.caustics == "off" else ParticleTracer(context, plan, scene)


def _block_of_sums(context: Context, what: str, size: int) -> moderngl.Buffer:
    most = int(context.gl.info["GL_MAX_SHADER_STORAGE_BLOCK_SIZE"])
    if size > most:
        raise RenderError(
            f"no room for {what}: they take {size >> 20} MiB in one block, and this driver grants "
            f"{most >> 20}. Render a smaller picture or a crop, or use --caustics off."
        )
    with context.checked(what):
        return context.gl.buffer(reserve=size)


def _limits(context: Context, plan: Plan) -> tuple[int | None, int]:
    """Loop rounds per dispatch (None: no limit), and the most particles per lane."""
    iterations = iterations_per_sample(plan) + rounds_for_particles(plan)
    rounds = usable_rounds(context)
    block = plan.settings.division.points
    return rounds, block if rounds is None else max(1, min(block, rounds // iterations))
