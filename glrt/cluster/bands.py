"""A picture as bands of whole rows, rendered by the workers of a cluster, and joined.

The bands follow from the picture alone. A pixel is seeded by its place in the frame, so the joined
picture has the bits of a render in one piece, on the same driver.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, fields, replace
from typing import Any

import numpy as np

from glrt.cluster.crew import Crew
from glrt.cluster.kept_bands import KeptBands
from glrt.core.errors import RenderError
from glrt.gpu.context import Choice, Pipeline
from glrt.image.allotment import NO_COUNTS, NO_SHARES
from glrt.image.aovs import AovImage
from glrt.image.film_state import FilmState
from glrt.image.group_channels import NO_GROUPS
from glrt.image.image import Image
from glrt.image.recipe import Recipe
from glrt.rendering.renderer import Renderer
from glrt.scene.scene import Scene
from glrt.settings import Settings

Crop = tuple[int, int, int, int]

MOST_BANDS = 64
TILE = 8  # rows of a work group
_BY_ROWS = 5  # arrays of a film state before its groups


def bands_of(settings: Settings) -> list[Crop]:
    """Return crops of whole rows that make the picture, or its crop, from above to below."""
    left, top, width, height = settings.crop or (0, 0, settings.width, settings.height)
    rows = TILE * -(-height // (TILE * MOST_BANDS))
    return [(left, top + y, width, min(rows, height - y)) for y in range(0, height, rows)]


@dataclass(frozen=True)
class PictureJob:
    """The bands of a picture, as a worker renders them."""

    scene: Scene
    settings: Settings
    context: Choice = "auto"
    pipeline: Pipeline = "auto"
    decisions: Mapping[str, str] = field(default_factory=dict)  # as in recipes

    def begin(self) -> "PictureWork":
        """Return the work, without having rendered any band."""
        return PictureWork(self)


class PictureWork:
    """Renders bands, with one renderer from band to band."""

    def __init__(self, job: PictureJob) -> None:
        """Open nothing yet."""
        self._job = job
        self._renderer: Renderer | None = None

    def do(self, number: int) -> tuple[Image, str]:
        """Return a band, and the route by which OpenGL was opened; raises `GlrtError`.

        The scene of its recipe names files and lacks their contents, which need not travel back.
        """
        job, crop = self._job, bands_of(self._job.settings)[number]
        if self._renderer:
            self._renderer.update(crop=crop)
            self._renderer.restart()
        else:
            settings = job.settings.model_copy(update={"crop": crop})
            self._renderer = Renderer(
                *(job.scene, settings, job.context, "complete", job.pipeline),
                decisions=job.decisions,
                opens_shutter=True,
            )
        image = self._renderer.render().image()
        assert image.recipe
        recipe = Recipe.from_json(image.recipe.to_json(), f"band {number}")
        return replace(image, recipe=recipe), self._renderer.context.route

    def release(self) -> None:
        """Release OpenGL."""
        if self._renderer:
            self._renderer.release()
        self._renderer = None


def render_bands(crew: Crew, job: PictureJob, kept: KeptBands) -> tuple[Image, str] | None:
    """Return the picture and the route by which OpenGL was opened; None after an interruption.

    The bands that are kept are not rendered again, and others are kept as they arrive. Raises the
    errors of a worker, and `RenderError` if the cluster ends.
    """
    count, route, is_told = len(bands_of(job.settings)), "", False
    if not crew.choose_driver():
        return None
    found = kept.found(job, crew.renderer)
    for number, value in crew.answers(job, [it for it in range(count) if it not in found]):
        if isinstance(value, RenderError):
            raise RenderError(f"Band {number} of {count} failed: {value}.")
        found[number], route = value
        try:
            kept.keep(number, found[number])
        except RenderError as error:
            if not is_told:
                crew.say(f"a band is not kept: {error} The render continues.")
            is_told = True
    if len(found) < count:
        return None
    return joined([found[number] for number in range(count)], job.settings), route


def joined(bands: Sequence[Image], settings: Settings) -> Image:
    """Return the picture of bands from above to below, with the settings of the whole."""
    first = bands[0]
    recipe = first.recipe and first.recipe.model_copy(
        update={"settings": first.recipe.settings.model_copy(update={"crop": settings.crop})}
    )
    states = [band.film_state for band in bands if band.film_state]
    return Image(
        _stacked([band.radiance for band in bands]),
        _stacked([band.stderr for band in bands]),
        first.samples,
        recipe,
        _joined_states(states) if len(states) == len(bands) else None,
        {name: _joined_aovs([band.aovs[name] for band in bands]) for name in first.aovs},
    )


def _joined_states(states: Sequence[FilmState]) -> FilmState:
    """Return the state of all rows; pixels have equal counts. Groups come before rows."""
    groups = [it.groups for it in states]
    means = np.concatenate(groups, axis=1) if len(groups[0]) else NO_GROUPS
    rows = [_stacked([state[k] for state in states]) for k in range(_BY_ROWS)]
    return FilmState._make([*rows, means, NO_COUNTS, NO_SHARES])


def _joined_aovs(parts: Sequence[AovImage]) -> AovImage:
    def rows(name: str) -> Any:
        arrays = [getattr(part, name) for part in parts]
        return None if arrays[0] is None else _stacked(arrays)

    return AovImage(**{part.name: rows(part.name) for part in fields(AovImage)})


def _stacked(arrays: Sequence[Any]) -> Any:
    return np.concatenate(arrays, axis=0)
