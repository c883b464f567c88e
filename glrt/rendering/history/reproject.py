"""History that follows the surfaces, blended with the film by numbers of samples."""

import moderngl

from glrt.gpu.canvas import Canvas
from glrt.gpu.program import TILE
from glrt.rendering.history.drawn_pass import DrawnPass
from glrt.rendering.history.gbuffer import Surfaces
from glrt.rendering.history.history_filter import Fresh
from glrt.rendering.history.reprojection import USUAL, Limits, Reprojection

OTHER_LIGHT = Limits(2.0, 2.0, 2.0)  # under changed light, history is wrong by an unknown amount


class Reproject:
    """History follows the surfaces; film and history are weighed by their numbers of samples."""

    def __init__(self, gl: moderngl.Context, limits: Limits = USUAL) -> None:
        """Nothing is compiled or allocated before it is needed."""
        self._reprojection = Reprojection(gl, limits)
        self._evidence, self._fade = DrawnPass(gl, "evidence.frag"), DrawnPass(gl, "fade.frag")
        self._tiles, self._canvas = Canvas(gl, "f4"), Canvas(gl, "f4")
        self._history: moderngl.Texture | None = None  # the newest of this view
        self._brought: moderngl.Texture | None = None

    def arrive(self, now: Surfaces, before: Surfaces | None, is_same_light: bool) -> None:
        """Reproject the last picture to the new view."""
        self._brought = None
        if before and self._history:
            limits = None if is_same_light else OTHER_LIGHT
            self._brought = self._reprojection.bring(now, before, self._history, limits)
        self._history = self._brought

    def show(self, now: Surfaces, fresh: Fresh) -> moderngl.Texture:
        """The picture: radiance in RGB, in a the number of samples that it stands for."""
        del now
        if not self._brought:
            self._history = None
            return self._draw(fresh, fresh.mean, 0.0)
        return self._draw(fresh, self._brought, fresh.end)

    def _draw(self, fresh: Fresh, brought: moderngl.Texture, end: float) -> moderngl.Texture:
        target = self._canvas.sized(fresh.mean.size)
        width, height = fresh.mean.size
        tiles = self._tiles.sized((-(-width // TILE), -(-height // TILE)))
        textures = {"light": fresh.light, "mean": fresh.mean, "brought": brought}
        self._evidence.draw(tiles, textures, {})
        assert self._tiles.texture
        textures["evidence"] = self._tiles.texture
        values = {"samples": float(fresh.samples), "end": end}
        self._fade.draw(target, textures, values)
        self._history = self._canvas.texture
        assert self._history
        return self._history

    def release(self) -> None:
        """Release all OpenGL resources."""
        for part in (self._reprojection, self._evidence, self._fade, self._tiles, self._canvas):
            part.release()
