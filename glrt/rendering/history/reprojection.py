"""Reproject what was shown of one view to another: history follows the surfaces.

History is taken over from a pixel with the same object, as far from the eye within 2 %, and facing
the same way within 25 degrees (shaders_glsl/passes/reprojection.glsl). Objects that moved or have
another pose take their history along.
"""

from typing import Any, NamedTuple

import moderngl
import numpy as np

from glrt.gpu.canvas import Canvas
from glrt.packing.scene_arrays import screen_axes
from glrt.rendering.history.deformed import View
from glrt.rendering.history.drawn_pass import DrawnPass
from glrt.rendering.history.gbuffer import Surfaces
from glrt.scene.scene import Scene


class Limits(NamedTuple):
    """The most samples of a pixel that history may stand for: old history may be wrong."""

    most: float = 64.0
    most_specular: float = 8.0  # in mirrors and glass, and out of focus
    most_at_edges: float = 2.0  # where samples may also meet another surface
    most_at_lamps: float = 0.0  # where that surface is a lamp


USUAL = Limits()
CONSTANTS = ("HAS_DEFORMED",)  # of passes/reprojection.glsl


def shares_objects(one: Scene, other: Scene) -> bool:
    """Whether object numbers mean the same in both scenes: equal shapes in equal order."""
    return [shape.shape for shape in one.visible] == [shape.shape for shape in other.visible]


def between(now: Surfaces, before: Surfaces) -> tuple[dict[str, moderngl.Texture], dict[str, Any]]:
    """Textures, uniforms and CONSTANTS of passes/reprojection.glsl.

    Both G-buffers must hold a view.
    """
    assert now.scene
    assert before.scene
    assert before.settings
    settings = before.settings
    axes = screen_axes(before.scene.camera, settings.width / settings.height)
    shift = np.subtract(now.scene.camera.position, before.scene.camera.position, dtype=np.float64)
    assert now.settings
    motion = now.motion.between(now.scene, before.scene)
    view = View(now.scene, now.settings, now.position, now.normal)
    deformed = now.deformed.between(view, before.scene)
    textures = {
        "position": now.position,
        "normal": now.normal,
        "before_position": before.position,
        "before_normal": before.normal,
        "motion": motion or now.position,
        "deformed": deformed[0] if deformed else now.position,
        "deformed_normal": deformed[1] if deformed else now.position,
    }
    values = {
        "eye_shift": shift,
        **{f"before_{name}": np.asarray(axis) for name, axis in axes.items()},
        "before_frame": np.array([settings.width, settings.height]),
        "before_origin": np.array(settings.crop[:2] if settings.crop else (0, 0)),
    }
    found: dict[str, Any] = {name: tuple(map(float, value)) for name, value in values.items()}
    moved = {"moved": motion.height if motion else 0, "HAS_DEFORMED": bool(deformed)}
    return textures, {**found, **moved}


class Reprojection:
    """Reprojects history from one view to another: radiance, and its number of samples."""

    def __init__(self, gl: moderngl.Context, limits: Limits = USUAL) -> None:
        """Nothing is compiled or allocated before it is needed."""
        self.limits = limits
        self._pass = DrawnPass(gl, "reproject.frag", CONSTANTS)
        self._canvases = [Canvas(gl, "f4"), Canvas(gl, "f4")]

    def bring(
        self,
        now: Surfaces,
        before: Surfaces,
        history: moderngl.Texture,
        limits: Limits | None = None,
    ) -> moderngl.Texture:
        """Reproject history to the view `now`: RGBA32F, a: samples, 0 where the surface is new.

        The texture stays valid through the next call, which may take it as history.
        """
        self._canvases.reverse()
        target = self._canvases[0].sized(now.size)
        textures, values = between(now, before)
        pixels = [width * height for width, height in (before.size, now.size)]
        own = {
            **(limits or self.limits)._asdict(),
            "density": min(pixels[0] / pixels[1], 1.0),
        }
        self._pass.draw(target, {**textures, "history": history}, {**values, **own})
        assert self._canvases[0].texture
        return self._canvases[0].texture

    def release(self) -> None:
        """Release all OpenGL resources."""
        self._pass.release()
        for canvas in self._canvases:
            canvas.release()
