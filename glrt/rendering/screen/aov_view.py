"""Draw AOVs as colours, on any framebuffer."""

import math
from typing import get_args

import moderngl
import numpy as np

from glrt.gpu.glsl import Source
from glrt.gpu.program import drawing
from glrt.rendering.aov_tracer import AovMean
from glrt.rendering.passes import aov_number
from glrt.rendering.screen.false_colors import VIRIDIS, Scale
from glrt.scene.camera import Camera
from glrt.settings import Aov, Settings, ToneMap

_VERSION = "410 core"
MOST_BOUNCES = 16  # numbers of bounces with colours of their own


def scale_of_bounces(limit: int) -> Scale:
    """The scale of colours for numbers of bounces, where paths have at most `limit`."""
    return Scale(VIRIDIS, 0.0, float(min(max(limit, 1), MOST_BOUNCES)), is_logarithmic=False)


def cell_of(camera: Camera) -> float:
    """The length after which the colours of the position repeat: a power of ten, scene units."""
    return 10.0 ** math.floor(math.log10(camera.resolved_focus_distance))


class AovView:
    """Draws the mean of an AOV on the framebuffer in use."""

    def __init__(self, gl: moderngl.Context) -> None:
        """Nothing is compiled before it is needed."""
        self._gl = gl
        self._program: moderngl.Program | None = None

    def draw(
        self, aov: Aov, mean: AovMean, camera: Camera, settings: Settings, bounces: int
    ) -> None:
        """Draw albedo as sRGB; normals around middle grey; near things bright; a colour an object.

        In the view of the depth, the focus distance of the camera is middle grey. Terms of light
        look as the picture does, with exposure and tone curve of the settings. `bounces` is the
        limit of the paths.
        """
        program = self._program or self._compile()
        mean.texture.use(0)
        cell = cell_of(camera)
        eye = np.remainder(np.array(camera.position, np.float64), cell)
        values = {
            "mean": 0,
            "part": mean.part,
            "parts": mean.parts,
            "aov": aov_number(aov),
            "eye": tuple(eye.tolist()),
            "distance": camera.resolved_focus_distance,
            "cell": cell,
            "colors": VIRIDIS,
            "most": scale_of_bounces(bounces).high,
            "exposure": settings.exposure,
            "tonemap": get_args(ToneMap).index(settings.tonemap),
        }
        for name, value in values.items():
            program[name] = value
        self._quad.render(moderngl.TRIANGLE_STRIP, vertices=4)

    def release(self) -> None:
        """Release program and quad."""
        if self._program:
            self._quad.release()
            self._program.release()

    def _compile(self) -> moderngl.Program:
        self._program = drawing(
            self._gl,
            Source("display.vert", version=_VERSION),
            Source("aov_view.frag", version=_VERSION),
        )
        self._quad = self._gl.vertex_array(self._program, [])
        return self._program
