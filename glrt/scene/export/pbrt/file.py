"""A scene as a scene file of pbrt-v4, of what that format holds."""

import math
from typing import Any

from glrt.core.text import quoted
from glrt.core.version import VERSION
from glrt.scene.export.companions import Companions
from glrt.scene.export.left_out import LeftOut
from glrt.scene.export.pbrt.materials import Materials
from glrt.scene.export.pbrt.media import Media
from glrt.scene.export.pbrt.shapes import Shapes
from glrt.scene.export.pbrt.skies import sky, sun
from glrt.scene.export.pbrt.text import comment, directive, numbers, with_parameters
from glrt.scene.export.pbrt.textures import Textures
from glrt.scene.export.placing import as_it_is
from glrt.scene.scene import Scene
from glrt.settings import Settings


def to_pbrt(scene: Scene, settings: Settings, companions: Companions) -> tuple[str, list[str]]:
    """Return the text of a scene file, and what is left out or changed, in words.

    `companions` receives the files that it names. The scene keeps its coordinates.
    """
    left_out = LeftOut()
    at = as_it_is(scene)
    textures, media = Textures(companions), Media(scene, left_out)
    materials = Materials(scene, textures, left_out)
    shapes = Shapes(scene, at, materials, companions, left_out)
    body = list[str]()
    if any(map(any, scene.background_colors)):
        body.append(sky(scene, companions))
    if any(scene.sun_radiance):
        body += sun(scene, at.extent)
    for index in scene.shown:
        item = scene.objects[index]
        name = item.name or f"{item.shape} {index}"
        lines = shapes.of(item, name, media.bounded_by(index))
        inner = [comment(name), *lines]
        body += ["AttributeBegin", *(f"    {line}" for line in inner), "AttributeEnd"]
    if scene.animation:
        left_out("the animation")
    if scene.render.method not in ("mis", "nee", "naive"):
        left_out(f"the method {quoted(scene.render.method)}")
    head = [comment(f"{scene.title or 'A scene'}, by glrt {VERSION}"), *media.lines]
    head += [*_view(scene, settings, media), "WorldBegin", *media.reset()]
    world = [*textures.lines, *materials.lines, *shapes.lines, *body]
    return "\n".join([*head, *world, ""]), left_out.things


def _view(scene: Scene, settings: Settings, media: Media) -> list[str]:
    camera = scene.camera
    width, height = settings.width, settings.height
    half = math.tan(math.radians(camera.fov) / 2) * min(1.0, width / height)
    lens: dict[str, Any] = {"float fov": 2 * math.degrees(math.atan(half))}  # of the shorter side
    if camera.defocus_angle:
        focus = camera.resolved_focus_distance
        lens["float lensradius"] = focus * math.tan(math.radians(camera.defocus_angle) / 2)
        lens["float focaldistance"] = focus
    film: dict[str, Any] = {"string filename": "pbrt.exr"}
    film |= {"integer xresolution": width, "integer yresolution": height}
    if settings.crop:
        left, top, wide, high = settings.crop
        film["integer pixelbounds"] = [left, left + wide, top, top + high]
    paths = {"integer maxdepth": settings.bounces}
    pixels = {"integer pixelsamples": settings.samples}
    box = {"float xradius": 0.5, "float yradius": 0.5}
    kind = "volpath" if media.are_there else "path"
    return [
        "Scale -1 1 1",  # pbrt is left-handed
        f"LookAt {numbers(camera.position)} {numbers(camera.look_at)} {numbers(camera.up)}",
        *media.around_camera(),
        with_parameters(directive("Camera", "perspective"), lens),
        with_parameters(directive("Film", "rgb"), film),
        with_parameters(directive("PixelFilter", "box"), box),
        with_parameters(directive("Sampler", "independent"), pixels),
        with_parameters(directive("Integrator", kind), paths),
    ]
