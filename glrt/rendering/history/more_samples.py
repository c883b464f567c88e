"""More samples of some pixels of a view: beside its film, which does not change.

The pixels are gathered into a list, so that those of a work group are all traced.
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
GROUPS = 256  # of a dispatch
OTHER_SEED = 0x5BD1E995  # apart from that of the film: its noise is not that of these samples


class MoreSamples:
    """Traces the pixels of a mask (shaders_glsl/gather.comp)."""

    samples = next_sample = 0  # as a kernel asks of what it fills

    def __init__(self, gl: moderngl.Context) -> None:
        """Nothing is compiled or allocated before it is needed."""
        self._gl = gl
        self._canvas = Canvas(gl, "f4")
        self._gather: Kernel | None = None

    def images(self) -> Images:
        """The textures under the names of the kernel's images."""
        assert self._canvas.texture
        return {"target_more": self._canvas.texture}

    def trace(
        self, renderer: Renderer, mask: moderngl.Texture, samples: int
    ) -> tuple[moderngl.Texture, int]:
        """Radiance, a: samples, valid at the pixels of the mask; and how many those are."""
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
            scene.lost_any()  # the film has lost none of these
        finally:
            pixels.release()
        assert self._canvas.texture
        return self._canvas.texture, count

    def release(self) -> None:
        """Free what the driver holds."""
        if self._gather:
            self._gather.release()
        self._gather = None
        self._canvas.release()
