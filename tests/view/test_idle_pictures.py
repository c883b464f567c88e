"""While a faster kernel has its turn, no bit of the picture and no preview changes."""

from typing import Any

import pytest

from glrt.gpu.context import Context
from glrt.plan.plan import Layering
from glrt.rendering.renderer import Renderer
from glrt.scene.scene import Scene, with_lights
from glrt.view.controls import replaced
from glrt.view.edits.scene_edits import with_material
from glrt.view.state.session import Session
from tests.support.builders import sphere
from tests.support.images import same_bits
from tests.support.mixed_scene import everything
from tests.support.sessions import Clock, Opening, Stage, frames, rested, walked


def aside(scene: Scene) -> Scene:
    first, *others = scene.objects
    moved = sphere([0.4, -0.3, 0.5], 0.4, "glass")
    return everything([moved, *(o.model_dump() for o in [first, *others])])


def turned(scene: Scene) -> Scene:
    return replaced(scene, camera=replaced(scene.camera, look_at=(0.2, 0.1, 0.0)))


def same_as_headless(session: Session, context: Context, layering: Layering = "groups") -> bool:
    """Whether the picture has the bits of a render by one kernel without a window."""
    rests = session.renderer
    assert rests
    kind: Any = {"layering": layering, "pipeline": session.pipeline}
    plain = Renderer(rests.scene, rests.settings, context, **kind)
    expected, image = plain.render(session.samples).image(), rests.image(session.weights)
    plain.release()
    assert image.recipe == expected.recipe
    return same_bits(image.radiance, expected.radiance) and same_bits(image.stderr, expected.stderr)


@pytest.mark.slow_cases("compute-independent")
@pytest.mark.parametrize(
    ("pipeline", "sampler"),
    [("compute", "sobol"), ("compute", "independent"), ("fragment", "sobol")],
)
def test_rest_edit_and_rest_again_give_the_bits_of_a_render_without_a_window(
    opened: Opening, clock: Clock, context: Context, pipeline: str, sampler: str
) -> None:
    if not context.is_software:
        pytest.skip("bits are promised on software drivers alone")
    layering: Layering = "groups" if pipeline == "compute" else "none"
    session = opened(Stage(), pipeline=pipeline, sampler=sampler)
    assert session.renderer
    assert rested(session, clock)
    frames(session, 33)
    assert same_as_headless(session, context, layering)
    for edit in (walked, aside):
        session.edit(edit(session.scene), "camera")
        frames(session, 1)
        assert session.samples == 1, "in the frame of the edit"
        frames(session, 3)
        assert same_as_headless(session, context, layering)
        assert rested(session, clock)
        frames(session, 40)
        assert same_as_headless(session, context, layering)


def test_light_that_is_weighed_and_a_camera_that_turns_leave_the_faster_kernel_its_turn(
    opened: Opening, clock: Clock, context: Context
) -> None:
    session = opened(Stage())
    assert session.renderer
    assert rested(session, clock)
    samples = session.samples
    session.edit(with_lights(session.scene, {"lamp": 0.5}))
    frames(session, 1)
    assert session.renderer.is_baked
    assert session.samples == samples + 1
    session.edit(turned(session.scene))
    frames(session, 1)
    assert session.renderer.is_baked
    session.edit(with_material(session.scene, "white", color=(0.1, 0.5, 0.2)))
    frames(session, 35)
    assert session.renderer.is_baked
    assert same_as_headless(session, context) or not context.is_software


def test_a_moving_camera_is_planned_by_the_kernel_that_it_will_have(
    opened: Opening, clock: Clock, monkeypatch: pytest.MonkeyPatch
) -> None:
    session = opened(Stage())
    assert rested(session, clock)
    learnt: list[tuple[float, ...]] = []
    monkeypatch.setattr(session._preview, "record", lambda *frame: learnt.append(frame))
    session.restart()
    frames(session, 3)
    assert not learnt
    session.edit(walked(session.scene))
    frames(session, 3)
    assert len(learnt) == 3
