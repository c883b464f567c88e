"""Weighted recursive least squares: a model of each pixel's history predicts the picture.

Iglesias-Guitian, Mane, Moon, "Real-Time Denoising of Volumetric Path Tracing for Direct Volume
Rendering" (2020). Models are reprojected from view to view, not colours.
"""

from typing import Literal

import moderngl

from glrt.gpu.canvas import Canvas
from glrt.gpu.context import checked
from glrt.rendering.history.drawn_pass import DrawnPass
from glrt.rendering.history.gbuffer import Surfaces
from glrt.rendering.history.history_filter import Fresh
from glrt.rendering.history.reprojection import CONSTANTS, between

Predictor = Literal["published", "delayed"]

TEXTURES = 8  # for each view: predictions, and seven rows of models (temporal/wrls_rows.glsl)


class Wrls:
    """Predicts the picture of a film by models that earlier views have fitted."""

    def __init__(self, gl: moderngl.Context, predictor: Predictor = "published") -> None:
        """Nothing is compiled or allocated before it is needed."""
        self._gl = gl
        self._predictor = predictor
        self._bring = DrawnPass(gl, "bring_models.frag", CONSTANTS)
        self._reconstruct = DrawnPass(gl, "reconstruct.frag")
        self._predict = DrawnPass(gl, "predict.frag")
        self._smooth = DrawnPass(gl, "predictions.frag")
        self._brought, self._made = (Canvas(gl, "f4", TEXTURES) for _ in range(2))
        self._shown = Canvas(gl, "f4")
        self._has_brought = self._has_made = False  # whether this view has such models
        self._frame = self._samples = 1.0  # samples of a frame, and of this view

    def arrive(self, now: Surfaces, before: Surfaces | None, is_same_light: bool) -> None:
        """Reproject the newest models, under any light: they adapt to it.

        While something moves, a view is one frame, however many samples it has, as in the paper.
        Under other light each sample is a frame, so that old light fades soon.
        """
        is_usable = before is not None and (self._has_made or self._has_brought)
        if self._has_made:
            self._frame = self._samples
        if not is_usable or not is_same_light:
            self._frame = 1.0
        if self._has_brought and not self._has_made:  # the view before had no sample
            self._brought, self._made = self._made, self._brought
        self._has_brought, self._has_made = is_usable, False
        if not before or not is_usable:
            return
        textures, values = between(now, before)
        target = self._sized(self._brought, now.size)
        self._bring.draw(target, {**textures, "known_row": self._made.textures[1:]}, values)

    def show(self, now: Surfaces, fresh: Fresh) -> moderngl.Texture:
        """The picture: radiance in RGB, in a the number of views that its model has seen."""
        size = fresh.mean.size
        has_history = self._has_brought and fresh.samples < fresh.end
        made, shown = self._sized(self._made, size), self._sized(self._shown, size)
        film = {"light": fresh.light, "mean": fresh.mean}
        numbers = {"samples": float(fresh.samples), "end": fresh.end}
        self._reconstruct.draw(shown, {**film, "position": now.position}, numbers)
        assert self._shown.texture
        rows = self._brought.textures[1:] if has_history else [fresh.mean] * (TEXTURES - 1)
        is_delayed = self._predictor == "delayed"
        values = {"has_history": has_history, "is_delayed": is_delayed, "frame": self._frame}
        self._predict.draw(made, {"light": self._shown.texture, "known_row": rows}, values)
        prediction, feature, *_ = self._made.textures
        textures = {**film, "prediction": prediction, "feature": feature}
        self._smooth.draw(shown, textures, numbers)  # in place of what it was predicted from
        self._has_made, self._samples = True, float(fresh.samples)
        return self._shown.texture

    @property
    def predictions(self) -> moderngl.Texture:
        """Texture of the last prediction: radiance, in a the weight of the film (0: no sample)."""
        return self._made.textures[0]

    def release(self) -> None:
        """Release all OpenGL resources."""
        for part in (self._bring, self._reconstruct, self._predict, self._smooth):
            part.release()
        for canvas in (self._brought, self._made, self._shown):
            canvas.release()
        self._has_brought = self._has_made = False

    def _sized(self, canvas: Canvas, size: tuple[int, int]) -> moderngl.Framebuffer:
        with checked(self._gl, f"models of {size[0]} x {size[1]} pixels"):
            return canvas.sized(size)
