"""Trace more samples of some pixels of a view, without a change of its film.

The pixels are gathered into a list, so that every lane of a work group has one to trace.
"""

from dataclasses import replace

import moderngl

from glrt.gpu.canvas import Canvas
from glrt.gpu.glsl import Source
from glrt.gpu.program import Images, Kernel
from glrt.gpu.programs import AnyKernel
from glrt.rendering.kernel_switch import taken
from glrt.rendering.passes import MORE
from glrt.rendering.renderer import Renderer
from glrt.rendering.schedule import DispatchRange
from glrt.settings import settings_for

GROUP = 64  # pixels of a work group
GROUPS = 256  # work groups of a dispatch
OTHER_SEED = 0x5BD1E995  # changes the film's seed, so that these samples have noise of their own


class MoreSamples:
    """Traces more samples of the pixels of a mask (shaders_glsl/gather.comp)."""

    samples = next_sample = 0  # required of whatever a kernel fills

    def __init__(self, gl: moderngl.Context) -> None:
        """Nothing is compiled or allocated before it is needed."""
        self._gl = gl
        self._canvas = Canvas(gl, "f4")
        self._gather: Kernel | None = None

    def images(self) -> Images:
        """The textures by the names of the kernel's image uniforms."""
        assert self._canvas.texture
        return {"target_more": self._canvas.texture}

    def trace(
        self, renderer: Renderer, mask: moderngl.Texture, samples: int
    ) -> tuple[moderngl.Texture, int]:
        """Texture of radiance, a: samples, valid at the mask's pixels; and the number of those."""
        scene, size = renderer.device_scene, mask.size
        seed = renderer.settings.seed ^ OTHER_SEED
        settings = settings_for(renderer.settings, seed=seed)
        plan = replace(renderer.plan, settings=settings)
        samples = min(samples, renderer.most_samples)
        self._canvas.sized(size).clear()
        pixels = self._gl.buffer(bytes(4 * (1 + size[0] * size[1])))

        def dispatch(kernel: AnyKernel, part: DispatchRange) -> None:
            own = {**renderer.probes.resources, "List": pixels}
            scene.dispatch(kernel, self, plan, part, GROUPS, own)

        try:
            self._gather = self._gather or Kernel(self._gl, Source("gather.comp"))
            self._gather.bind({"List": pixels, "mask": mask}, {})
            self._gather.run(*size)
            count = int.from_bytes(pixels.read(4), "little")
            groups = -(-count // GROUP)
            with taken(renderer.context, scene.shaders_of(MORE), dispatch) as kernel:
                for first in range(0, groups, GROUPS):
                    dispatch(kernel, DispatchRange(samples, first, min(GROUPS, groups - first)))
                    renderer.context.finish()
            scene.lost_any()  # clears the count: losses here are not the film's
        finally:
            pixels.release()
        assert self._canvas.texture
        return self._canvas.texture, count

    def release(self) -> None:
        """Release all OpenGL resources."""
        if self._gather:
            self._gather.release()
        self._gather = None
        self._canvas.release()
