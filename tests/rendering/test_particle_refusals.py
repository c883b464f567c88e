"""Where particles from lamps cannot go: refused by name before anything compiles."""

from typing import Any

import pytest

from glrt.core.errors import UsageError
from glrt.gpu.context import Context
from glrt.rendering.renderer import Renderer
from glrt.scene.scene import Scene
from tests.support.builders import scene_of, sphere
from tests.support.particle_rooms import BALL, LAMP, MATERIALS, ROOMS, room
from tests.support.renders import rendering

ON: dict[str, Any] = {"caustics": "on"}

MANY = [sphere([0.1 * k, 0.5, -3], 0.02, "lamp") for k in range(40)]
REFUSED: dict[str, tuple[Scene, dict[str, Any]]] = {
    "method mis alone, not by nee": (ROOMS["a lens"], {"method": "nee"}),
    "no sphere, quad, disk, mesh, sun or sky shines": (room(BALL), {}),
    "of 40 lamps, too many": (room(*MANY), {}),
    "some surfaces have holes": (
        scene_of([LAMP, BALL], {**MATERIALS, "glass": {"type": "principled", "alpha": 0.5}}),
        {},
    ),
    "a lamp, sun or sky is in tinted glass or one with a priority": (
        room(LAMP, sphere([0, 0.9, -0.2], 0.4, "water")),
        {},
    ),
    "the camera is in glass with a priority": (room(LAMP, sphere([0, 0, 1], 0.5, "water")), {}),
    "is in tinted glass": (
        room(sphere([0, 0, -0.3], 0.1, "lamp"), sphere([0, 0, -0.3], 0.3, "tinted")),
        {},
    ),
}


@pytest.mark.parametrize("reason", REFUSED)
def test_what_particles_cannot_do_is_refused_by_name(context: Context, reason: str) -> None:
    scene, settings = REFUSED[reason]
    with pytest.raises(UsageError, match=reason):
        Renderer(scene, context=context, **settings, **ON)


@pytest.mark.slow
def test_an_update_is_refused_likewise_and_changes_nothing(context: Context) -> None:
    with rendering(ROOMS["a lens"], context, **ON) as renderer:
        renderer.render(3)
        with pytest.raises(UsageError, match="not by naive"):
            renderer.update(method="naive")
        assert (renderer.samples, renderer.settings.method) == (3, "mis")
