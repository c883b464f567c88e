"""Probes that go on from picture to picture: what they hold after each update, in closed form."""

from typing import Any

import numpy as np
import pytest

from glrt.core.errors import UsageError
from glrt.gpu.context import Context
from glrt.packing.probes import IN_ROW
from glrt.rendering.probe_tracer import UPDATES, ProbeTracer, kept_light
from glrt.rendering.renderer import Renderer
from glrt.scene.scene import Scene, with_lights
from tests.support.builders import MATTE, lamp, scene_of, sphere
from tests.support.images import same_bits
from tests.support.renders import rendered, rendering
from tests.truths.test_probes import WAY, inner, room

KEPT = 0.75
DIM = 0.25


def dimmed(scene: Scene) -> Scene:
    return with_lights(scene, {"glow": DIM})


def tracer_of(renderer: Renderer) -> ProbeTracer:
    assert renderer.probes.tracer
    return renderer.probes.tracer


def warmed_up(albedo: float) -> float:
    """The light that probes hold in a room that shines with 1: E / pi, of one bounce and more."""
    held = 0.0
    for update in range(UPDATES):
        kept = kept_light(update)
        held = kept * held + (1 - kept) * albedo * (1 + held)
    return held


def lit(renderer: Renderer) -> Any:
    """E / pi, as the maps hold it."""
    return inner(tracer_of(renderer), "probe_light") / np.pi


@pytest.mark.parametrize("albedo", [0.01, 0.5])
def test_light_follows_a_step_by_what_each_update_keeps(context: Context, albedo: float) -> None:
    """Each update brings light of the room as it is now, and of what the probes held before it."""
    scene = room("sphere", albedo)
    with rendering(scene, context, **WAY, bounces=3, roulette=False) as renderer:
        renderer.render(1)
        held = warmed_up(albedo)
        with context.gl:
            np.testing.assert_allclose(lit(renderer), held, rtol=1e-4)
        for number in range(6):
            renderer.update(dimmed(scene), hysteresis=KEPT, seed=number)
            renderer.render(1)
            held = KEPT * held + (1 - KEPT) * albedo * (DIM + held)
            with context.gl:
                np.testing.assert_allclose(lit(renderer), held, rtol=1e-4)
        assert renderer.probes.lag == pytest.approx(KEPT**6)


@pytest.mark.slow
def test_half_of_a_step_is_there_after_23_updates_that_keep_97_of_100(context: Context) -> None:
    """ln 2 / -ln 0.97 is 22.8; in an almost black room, where one bounce is all."""
    scene = room("planes", 0.001)
    with rendering(scene, context, **WAY, bounces=3, roulette=False) as renderer:
        renderer.render(1)
        renderer.update(dimmed(scene), hysteresis=0.97)
        passed = []
        with context.gl:
            for _ in range(23):
                before = float(lit(renderer).mean(dtype=float))
                tracer_of(renderer).follow(0.97)
                after = float(lit(renderer).mean(dtype=float))
                passed.append((before, after))
    steps = [(before - DIM * 0.001) / (0.75 * 0.001) for before, _ in passed]
    assert steps[0] == pytest.approx(1.0, rel=2e-3)
    assert steps[22] > 0.5 > (passed[22][1] - DIM * 0.001) / (0.75 * 0.001)


def test_what_rests_has_the_bits_of_a_picture_of_its_own(context: Context) -> None:
    scene = room("planes", 0.5)
    with rendering(scene, context, **WAY) as renderer:
        renderer.render(2)
        renderer.update(dimmed(scene), hysteresis=KEPT)
        renderer.render(2)
        assert renderer.probes.lag == KEPT
        assert renderer.update(dimmed(scene)) is not None
        assert renderer.probes.lag == 0.0
        image = renderer.render(2).image()
    assert same_bits(image.radiance, rendered(dimmed(scene), context, 2, **WAY).radiance)


def test_a_picture_begins_with_probes_of_its_own(context: Context) -> None:
    """The earlier picture's probes do not count: neither their light nor their places."""
    way = {name: value for name, value in WAY.items() if name != "probes"}
    places: list[list[float]] = [[1, 1, 1], [-1, -1, 0.6]]
    found = []
    for place in places:
        with rendering(ball_at(place), context, **way) as renderer:
            renderer.render(1)
            renderer.update(ball_at([1, -1, 0]))
            found.append(renderer.render(1).image().radiance)
    assert same_bits(*found)


def test_a_picture_by_live_probes_is_not_handed_out(context: Context) -> None:
    scene = room("planes", 0.5)
    with rendering(scene, context, **WAY) as renderer:
        renderer.render(1)
        renderer.update(dimmed(scene), hysteresis=KEPT)
        found, told = None, ""
        try:
            found = renderer.render(1).image()
        except UsageError as error:
            told = str(error)
    assert found is None
    assert "cannot be rendered again" in told


def test_a_restart_is_an_update_more(context: Context) -> None:
    scene = room("planes", 0.5)
    with rendering(scene, context, **WAY) as renderer:
        renderer.render(1)
        renderer.update(dimmed(scene), hysteresis=KEPT)
        renderer.render(40)  # beyond a block: the probes stay
        assert renderer.probes.lag == KEPT
        renderer.restart()
        renderer.render(1)
        assert renderer.probes.lag == pytest.approx(KEPT**2)


def test_probes_of_another_number_are_warmed_up(context: Context) -> None:
    scene = room("planes", 0.5)
    with rendering(scene, context, **WAY) as renderer:
        renderer.render(1)
        renderer.update(dimmed(scene), hysteresis=KEPT, probes=3)
        renderer.render(1)
        assert renderer.probes.lag == 0.0
        with context.gl:
            np.testing.assert_allclose(lit(renderer), DIM * warmed_up(0.5), rtol=1e-3)


def used(tracer: ProbeTracer) -> Any:
    """Which probes are of use, (probes,)."""
    texture = tracer.maps["probe_places"]
    found = np.frombuffer(texture.read(), np.float32).reshape(-1, IN_ROW, 4)[..., 3]
    return found.reshape(-1)[: tracer.grid.probes] > 0


def ball_at(place: list[float]) -> Scene:
    """A ball that may hold a probe of 8, in a room."""
    things = [sphere([0, 0, 0], 2, "glow"), sphere(place, 0.95, "wall")]
    camera = {"position": [0, 0, 0.1], "look_at": [0, 0, -1], "fov": 60}
    given = {"min": [-2, -2, -2], "max": [2, 2, 2], "counts": [2, 2, 2]}
    return scene_of(things, {"glow": lamp(1.0, 0.5), "wall": MATTE}, camera, probes=given)


def test_places_and_distances_follow_what_is_moved(context: Context) -> None:
    """The probe at (1, 1, 1), the last, is in the middle of the ball at first: of no use."""
    way = {name: value for name, value in WAY.items() if name != "probes"}
    with rendering(ball_at([1, 1, 1]), context, **way) as renderer:
        renderer.render(1)
        with context.gl:
            assert used(tracer_of(renderer)).tolist() == [True] * 7 + [False]
            before = inner(tracer_of(renderer), "probe_distances")[0, ..., 0].copy()
        renderer.update(ball_at([-1, -1, 0.6]), hysteresis=KEPT)
        renderer.render(1)
        with context.gl:
            assert used(tracer_of(renderer)).all()
            after = inner(tracer_of(renderer), "probe_distances")[0, ..., 0]
    nearer = before - after  # of the first, at (-1, -1, -1), which has the ball above it now
    assert nearer.max() > 0.25
    assert np.median(np.abs(nearer)) < 0.03


def test_live_probes_leave_methods_without_any_alone(context: Context) -> None:
    scene = room("planes", 0.5)
    with rendering(scene, context) as renderer:
        renderer.render(1)
        renderer.update(dimmed(scene), hysteresis=KEPT)
        assert renderer.probes.lag == 0.0
        assert not renderer.probes.resources
        assert renderer.render(1).image().samples == 1
