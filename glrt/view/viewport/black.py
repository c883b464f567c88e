"""Find why the picture is black: lights that are off, or a camera that no light reaches."""

from collections.abc import Hashable

import numpy as np

from glrt.rendering.renderer import Renderer
from glrt.scene.lit_scene import SKY_GROUP, SUN_GROUP
from glrt.scene.scene import Scene
from glrt.view.edits.state_differences import name_of
from glrt.view.state.session import Session
from glrt.view.viewport.orbit import axes
from glrt.view.viewport.pick import first_along
from glrt.view.viewport.picture import Picture

FAINT = 1e-7  # radiance: below it, pixels are black at every exposure of the slider
PATHS = 20_000  # after so many, a picture that is not black has most likely shown some light


class Blackness:
    """Checks a picture after PATHS paths, twice as many, and so on: reading it takes time.

    It is checked once more when it is complete.
    """

    def __init__(self) -> None:
        """Begin without a check."""
        self.reason = ""  # why the picture is black; "" where it is not, or not known to be
        self._content: Hashable = None
        self._seen = 0  # samples, at the last check

    def look(self, session: Session, picture: Picture) -> None:
        """Check the picture if that is due; call it once a frame, after the picture is drawn."""
        settings, renderer = session.settings, session.renderer
        if not renderer or session.is_preview or not session.samples:
            self.reason, self._content = "", None
            return
        content = session.restarts, session.weights, settings.exposure, settings.tonemap
        if content != self._content:
            self.reason, self._content, self._seen = "", content, 0
        first = PATHS / (settings.width * settings.height)
        is_more = session.samples >= max(first, 2 * self._seen)
        if is_more or (session.is_done and session.samples != self._seen):
            self._seen = session.samples
            is_black = not picture.codes()[..., :3].any()
            self.reason = why_black(session, renderer) if is_black else ""


def why_black(session: Session, renderer: Renderer) -> str:
    """Return the most likely reason in a sentence."""
    scene = renderer.scene
    if renderer.picture(session.weights)[0].max() > FAINT:
        return "Black at this exposure: the light in view is too dim for the screen"
    if not shines(scene):
        return "Black: every light is off, or there is none"
    around = surrounding(scene)
    if around is not None:
        return f"Black: the camera is inside {name_of(scene.objects[around])}"
    if session.settings.bounces == 0:
        return "Black: 0 bounces show lamps and background alone, and none is in view"
    return "Black: no light reaches what is in view; the camera may have gone through a wall"


def shines(scene: Scene) -> bool:
    """Whether something emits light and is not turned off: an object, the sun or the sky."""
    groups = {scene.finish(shape).group for shape in scene.visible}
    groups |= {SUN_GROUP} if scene.sun else set()
    groups |= {SKY_GROUP} if any(map(any, scene.background.gradient)) else set()
    return any(x > 0 for group, x in scene.light_groups.items() if group in groups)


def surrounding(scene: Scene) -> int | None:
    """Return the object that is hit first on all six sides of the camera; None if not one is."""
    eye = np.array(scene.camera.position)
    sides = [sign * np.array(axis) for axis in axes(scene.camera) for sign in (1.0, -1.0)]
    first = first_along(scene, eye, sides[0])
    met = (first_along(scene, eye, side) for side in sides[1:])
    is_around = first is not None and all(other and other[0] == first[0] for other in met)
    return first[0] if first is not None and is_around else None
