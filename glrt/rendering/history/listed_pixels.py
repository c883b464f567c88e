"""Samples of listed pixels alone, at full size and apart from the film."""

import moderngl

from glrt.gpu.canvas import Canvas
from glrt.gpu.program import Images
from glrt.gpu.programs import AnyKernel
from glrt.plan.plan import Plan
from glrt.rendering.kernel_switch import taken
from glrt.rendering.pass_film import Size
from glrt.rendering.passes import MORE
from glrt.rendering.renderer import Renderer
from glrt.rendering.schedule import DispatchRange

GROUP = 64  # pixels of a work group
GROUPS = 256  # work groups of a dispatch


class ListedPixels:
    """Traces the pixels of a list (shaders_glsl/more.comp); compute shaders alone can."""

    samples = 0  # required of whatever a kernel fills

    def __init__(self, gl: moderngl.Context) -> None:
        """Nothing is compiled or allocated before it is needed."""
        self._canvas = Canvas(gl, "f4")
        self.next_sample = 0  # number of the first sample, as films count them

    def images(self) -> Images:
        """The textures by the names of the kernel's image uniforms."""
        assert self._canvas.texture
        return {"target_more": self._canvas.texture}

    def clear(self, size: Size) -> None:
        """Begin a picture of `size` pixels, with 0 everywhere; needs a current context."""
        self._canvas.sized(size).clear()

    def trace(
        self, renderer: Renderer, plan: Plan, pixels: moderngl.Buffer, count: int, samples: int
    ) -> moderngl.Texture:
        """Add `count` pixels to the picture: radiance, a: finite samples; needs a current context.

        `pixels`: uint32, their number, and each as x + width y. Raises RenderError if the driver
        refuses the kernel.
        """
        scene = renderer.device_scene

        def dispatch(kernel: AnyKernel, part: DispatchRange) -> None:
            own = {**renderer.probes.resources, "List": pixels}
            scene.dispatch(kernel, self, plan, part, GROUPS, own)

        groups = -(-count // GROUP)
        with taken(renderer.context, scene.shaders_of(MORE), dispatch) as kernel:
            for first in range(0, groups, GROUPS):
                dispatch(kernel, DispatchRange(samples, first, min(GROUPS, groups - first)))
                renderer.context.finish()
        scene.lost_any()  # clears the count: losses here are not the film's
        assert self._canvas.texture
        return self._canvas.texture

    def release(self) -> None:
        """Release all OpenGL resources."""
        self._canvas.release()
