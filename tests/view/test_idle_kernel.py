"""While nothing is edited a faster kernel takes over: when, what ends it, and no bit tells."""

from collections.abc import Callable, Iterator
from typing import Any

import pytest

from glrt.errors import RenderError
from glrt.gpu.context import Context
from glrt.methods.light_layers import Layering
from glrt.rendering.pipelines import MOST_BAKED
from glrt.rendering.renderer import Renderer
from glrt.scene.scene import Scene, with_lights
from glrt.settings import settings_for
from glrt.view.panels.objects import with_material
from glrt.view.state.controls import replaced
from glrt.view.state.idle_compile import Finding, TrialCompile
from glrt.view.state.idle_kernel import LONGEST, MOST, PAUSE, IdleKernel
from glrt.view.state.preview_size import STILL
from glrt.view.state.session import ANNOUNCED, Session
from tests.support.builders import MATTE, scene_of, sphere
from tests.support.images import same_bits
from tests.support.mixed_scene import everything

GOOD = Finding(0.01, is_same=True)


class Clock:
    """Time that passes as told; each reading costs a millisecond."""

    now = 100.0

    def __call__(self) -> float:
        self.now += 0.001
        return self.now


class Played:
    """A rehearsal whose end and finding are told."""

    def __init__(self, finding: Finding | None) -> None:
        self.is_over, self.is_ended = True, False
        self._finding = finding

    def finding(self) -> Finding | None:
        return self._finding

    def end(self) -> None:
        self.is_ended = True


class Stage:
    """Where rehearsals are played: each has the next finding, the last for ever."""

    def __init__(self, *findings: Finding | None) -> None:
        self.findings = list(findings)
        self.played: list[Played] = []
        self.is_over = True

    def __call__(self, _: Renderer) -> Any:
        finding = self.findings.pop(0) if len(self.findings) > 1 else self.findings[0]
        self.played.append(Played(finding))
        self.played[-1].is_over = self.is_over
        return self.played[-1]


Opening = Callable[..., Session]


@pytest.fixture
def clock() -> Clock:
    return Clock()


@pytest.fixture
def opened(context: Context, clock: Clock) -> Iterator[Opening]:
    """Opens a session whose rehearsals are played, and lets it get its first samples."""
    sessions: list[Session] = []

    def opening(stage: Callable[[Renderer], Any], **ways: Any) -> Session:
        scene = ways.pop("scene", everything())
        pipeline = ways.pop("pipeline", "auto")
        sizes = {"width": 24, "height": 16, "bounces": 3, "samples": 1000}
        settings = settings_for(scene.render, **{**sizes, **ways})
        rest = IdleKernel(clock, stage)
        session = Session(scene, settings, context, clock, pipeline, rest)
        sessions.append(session)
        frames(session, ANNOUNCED + 1)
        return session

    with context.gl:
        yield opening
        for session in sessions:
            session.release()


def frames(session: Session, count: int) -> None:
    for _ in range(count):
        session.advance(1e-3, count=1)


def rested(session: Session, clock: Clock) -> bool:
    """Let a pause pass; whether the faster kernel then has its turn."""
    frames(session, 1)
    clock.now += STILL
    frames(session, 1)  # at full size again, if the camera has moved
    clock.now += PAUSE
    frames(session, 3)
    assert session.renderer
    return session.renderer.is_baked


def aside(scene: Scene) -> Scene:
    first, *others = scene.objects
    moved = sphere([0.4, -0.3, 0.5], 0.4, "glass")
    return everything([moved, *(o.model_dump() for o in [first, *others])])


def turned(scene: Scene) -> Scene:
    return replaced(scene, camera=replaced(scene.camera, look_at=(0.2, 0.1, 0.0)))


def walked(scene: Scene) -> Scene:
    return replaced(scene, camera=replaced(scene.camera, position=(0.2, 0.1, 2.5)))


def same_as_headless(session: Session, context: Context, layering: Layering = "groups") -> bool:
    """Whether the picture has the bits of a render by one kernel without a window."""
    rests = session.renderer
    assert rests
    kind: Any = {"layering": layering, "pipeline": session.pipeline}
    plain = Renderer(rests.scene, rests.settings, context, **kind)
    expected, image = plain.render(session.samples).image(), session.image()
    plain.release()
    assert image.recipe == expected.recipe
    return same_bits(image.radiance, expected.radiance) and same_bits(image.stderr, expected.stderr)


# --- what a user sees --------------------------------------------------------------------------


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
    session = opened(Stage(GOOD), pipeline=pipeline, sampler=sampler)
    assert session.renderer
    assert rested(session, clock)
    frames(session, 33)
    assert same_as_headless(session, context, layering)
    for edit in (walked, aside):
        session.edit(edit(session.scene), "camera")
        frames(session, 1)
        assert not session.renderer.is_baked
        assert session.samples == 1, "in the frame of the edit"
        frames(session, 3)
        assert same_as_headless(session, context, layering)
        assert rested(session, clock)
        frames(session, 40)
        assert same_as_headless(session, context, layering)


def test_light_that_is_weighed_and_a_camera_that_turns_leave_the_faster_kernel_its_turn(
    opened: Opening, clock: Clock, context: Context
) -> None:
    session = opened(Stage(GOOD))
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
    session = opened(Stage(GOOD))
    assert rested(session, clock)
    learnt: list[float] = []
    monkeypatch.setattr(session._preview, "record", learnt.append)
    session.restart()
    frames(session, 3)
    assert not learnt
    session.edit(walked(session.scene))
    frames(session, 3)
    assert len(learnt) == 3


# --- when --------------------------------------------------------------------------------------


def test_nothing_is_rehearsed_before_a_pause_nor_after_the_last_sample(
    opened: Opening, clock: Clock
) -> None:
    stage = Stage(GOOD)
    session = opened(stage, samples=40)
    for _ in range(4):
        session.edit(seed=session.settings.seed + 1)
        frames(session, 1)
        clock.now += 0.9 * PAUSE
    session.edit(seed=0)
    while not session.is_done:
        frames(session, 1)
    clock.now += 2 * PAUSE
    frames(session, 3)
    assert not stage.played
    session.edit(samples=100)
    frames(session, 1)
    assert len(stage.played) == 1


def test_an_edit_ends_a_rehearsal_and_a_window_that_closes_too(
    opened: Opening, clock: Clock
) -> None:
    stage = Stage(GOOD)
    stage.is_over = False
    session = opened(stage)
    assert not rested(session, clock)
    session.edit(seed=4)
    frames(session, 1)
    assert [one.is_ended for one in stage.played] == [True]
    assert not rested(session, clock)
    assert [one.is_ended for one in stage.played] == [True, False]
    session.release()
    assert stage.played[1].is_ended


def test_many_shapes_are_not_rehearsed(opened: Opening, clock: Clock) -> None:
    stage = Stage(GOOD)
    balls = [sphere([i, 0, -9], 0.4, "m") for i in range(MOST_BAKED + 1)]
    many = scene_of(balls, {"m": MATTE}, background={"color": [1, 1, 1]})
    session = opened(stage, scene=many)
    assert not rested(session, clock)
    assert not stage.played


@pytest.mark.parametrize("finding", [Finding(1.01 * LONGEST, True), Finding(0.01, False)])
def test_a_driver_that_would_stall_or_round_otherwise_is_left_alone_for_good(
    opened: Opening, clock: Clock, finding: Finding
) -> None:
    stage = Stage(finding, GOOD)
    session = opened(stage)
    assert not rested(session, clock)
    session.edit(seed=1)
    assert not rested(session, clock)
    assert len(stage.played) == 1


def test_a_rehearsal_that_failed_is_tried_again_after_the_next_edit(
    opened: Opening, clock: Clock
) -> None:
    stage = Stage(None, GOOD)
    session = opened(stage)
    assert not rested(session, clock)
    assert not rested(session, clock)
    assert len(stage.played) == 1
    session.edit(seed=1)
    assert rested(session, clock)


def test_where_no_process_can_be_started_the_window_goes_on(opened: Opening, clock: Clock) -> None:
    tried: list[Renderer] = []

    def begin(renderer: Renderer) -> TrialCompile:
        tried.append(renderer)
        raise OSError("no more processes")

    session = opened(begin)
    for seed in range(2):
        session.edit(seed=seed)
        assert not rested(session, clock)
    assert len(tried) == 1
    assert (session.samples > 0, session.problem) == (True, "")


def test_a_window_that_stood_still_once_does_not_again(
    opened: Opening, clock: Clock, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As where the driver's cache is not shared after all."""
    session = opened(Stage(GOOD))
    bake = Renderer.bake

    def slow(renderer: Renderer) -> bool:
        clock.now += MOST
        return bake(renderer)

    monkeypatch.setattr(Renderer, "bake", slow)
    assert rested(session, clock)
    session.edit(walked(session.scene))
    assert not rested(session, clock)


def test_a_kernel_that_is_refused_here_leaves_the_other(
    opened: Opening, clock: Clock, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(_: Renderer) -> bool:
        raise RenderError("no")

    session = opened(Stage(GOOD))
    monkeypatch.setattr(Renderer, "bake", refuse)
    assert not rested(session, clock)
    samples = session.samples
    frames(session, 2)
    assert (session.samples, session.problem) == (samples + 2, "")
