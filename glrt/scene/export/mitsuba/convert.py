"""A scene in the words of Mitsuba."""

import math
from typing import Any, NamedTuple

from glrt.core.text import quoted
from glrt.scene.export.left_out import Report
from glrt.scene.export.mitsuba.media import Media
from glrt.scene.export.mitsuba.shapes import Shapes
from glrt.scene.export.mitsuba.skies import sky, sun
from glrt.scene.export.mitsuba.surfaces import Surfaces
from glrt.scene.export.mitsuba.words import COMMENT, Words
from glrt.scene.export.placing import Placing, unit
from glrt.scene.scene import Scene
from glrt.settings import Settings

ROULETTE_DEPTH = 5  # where it starts by Mitsuba's own choice
NEVER = 1 << 30
# From the lens, over the extent of the scene: Mitsuba renders nothing before it and beyond.
CLIP = 1e-6, 2.0**20


class Choices(NamedTuple):
    """How a scene is converted."""

    at: Placing  # the coordinates in which Mitsuba gets it
    sampler: str = "independent"  # of the samplers of Mitsuba
    sample_count: int = 1
    one_sided: bool = False  # whether flat lamps light their front alone
    reach: float | None = None  # of planes, over the extent of the scene; None: to the horizon


def convert(
    scene: Scene, settings: Settings, choices: Choices, surfaces: Surfaces, report: Report
) -> Words:
    """Return the scene; `report` takes each thing that Mitsuba does not show, in words."""
    at, media = choices.at, Media(scene, choices.at, report)
    words: Words = {
        "type": "scene",
        "integrator": {
            "type": media.integrator,
            "max_depth": settings.bounces + 1,  # Mitsuba counts segments
            "rr_depth": ROULETTE_DEPTH if settings.roulette else NEVER,
        },
        "camera": {**_camera(scene, settings, choices), **media.around_camera()},
    }
    if any(map(any, scene.background_colors)):
        words["background"] = sky(scene)
    if any(scene.sun_radiance):
        words["sun"] = sun(scene, at.extent)
    shapes = Shapes(scene, at, surfaces, report, choices.one_sided, choices.reach)
    for index in scene.shown:
        item = scene.objects[index]
        name = item.name or f"{item.shape} {index}"
        for side, part in enumerate(shapes.of(item, name)):
            told = {COMMENT: item.name} if item.name else {}
            words[f"object {index} {side}"] = {**part, **media.bounded_by(index), **told}
    _report_rest(scene, report)
    return words


def _camera(scene: Scene, settings: Settings, choices: Choices) -> Words:
    camera, at = scene.camera, choices.at
    focus = camera.resolved_focus_distance * at.factor
    radius = focus * math.tan(math.radians(camera.defocus_angle) / 2)
    lens: Words = {"type": "perspective"}
    if radius:
        lens = {"type": "thinlens", "aperture_radius": radius, "focus_distance": focus}
    eye = at.point(camera.position)
    ahead = eye + at.extent * unit(camera.view)
    near, far = (clip * at.extent for clip in CLIP)
    return {
        **lens,
        "to_world": {"type": "look_at", "places": (eye, ahead, unit(camera.up))},
        "fov": camera.fov,
        "fov_axis": "y",
        "near_clip": near,
        "far_clip": far,
        "sampler": {"type": choices.sampler, "sample_count": choices.sample_count},
        "film": _film(settings),
    }


def _film(settings: Settings) -> Words:
    crop: dict[str, Any] = {}
    if settings.crop:
        names = ("crop_offset_x", "crop_offset_y", "crop_width", "crop_height")
        crop = dict(zip(names, settings.crop, strict=True))
    return {
        "type": "hdrfilm",
        "width": settings.width,
        "height": settings.height,
        **crop,
        "pixel_format": "rgb",
        "component_format": "float32",
        "rfilter": {"type": "box"},
    }


def _report_rest(scene: Scene, report: Report) -> None:
    if scene.animation:
        report("the animation")
    if scene.render.method not in ("mis", "nee", "naive"):
        report(f"the method {quoted(scene.render.method)}")
