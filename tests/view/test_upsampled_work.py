"""Coarse pictures of a drag at full size: their steps, and when the film follows."""

from collections.abc import Iterator
from types import SimpleNamespace
from typing import Any

import pytest

from glrt.core.errors import UsageError
from glrt.gpu.context import Context
from glrt.image.sources import load
from glrt.rendering.history.temporal import Way
from glrt.rendering.history.upsample import Upsample
from glrt.rendering.renderer import Renderer
from glrt.settings import Method, settings_for
from glrt.view.controls import replaced
from glrt.view.state.preview_size import STILL, Preview
from glrt.view.state.session import Session
from glrt.view.state.upsampled_work import UpsampledWork, factor_of
from tests.support.images import same_bits
from tests.support.sessions import Clock, start

PIXELS = 640 * 480


class Moving:
    """Coarse pictures that take no time of their own: a second a million samples."""

    def __init__(self, clock: Clock) -> None:
        self.clock, self.factors, self.step = clock, list[int](), 0

    @property
    def progress(self) -> tuple[int, int]:
        return len(self.factors), self.step

    @property
    def factor(self) -> int:
        return self.factors[-1]

    def upsample(self, renderer: Any, factor: int, sampled: Any) -> None:
        self.clock.now += 2 * PIXELS / factor**2 * 1e-6
        sampled()
        self.factors.append(factor)
        self.step = min(self.step or factor, factor)


def frames(budget: float, rest: int) -> list[int]:
    """Factors of the frames of a drag, and of some frames after it."""
    clock = Clock()
    clock.step = 0.0
    moving, preview = Moving(clock), Preview(clock)
    given: Any = moving
    work = UpsampledWork(given, preview, clock)
    renderer: Any = SimpleNamespace(size=(640, 480), context=SimpleNamespace(finish=lambda: None))
    preview.record(1.0, 1e6)
    for _ in range(3):
        preview.begin(PIXELS, budget)
        work.work(renderer, 1, budget, 0.0)
        preview.deliver()
    clock.now += STILL
    for _ in range(rest):
        work.work(renderer, 1, budget, 0.0)
    return moving.factors


def test_a_lattice_takes_the_time_of_a_sample_at_the_reduced_size() -> None:
    """A sampled pixel has two samples: the distance is larger by the root of 2, and a factor."""
    assert [factor_of(reduced) for reduced in (1.1, 1.42, 2.8, 2.9, 5.6, 8.0)] == [2, 4, 4, 8, 8, 8]


def test_at_rest_distances_halve_as_soon_as_that_fits_into_a_frame() -> None:
    assert frames(0.05, 2) == [4, 4, 4, 4, 4], "0.15 s for one pixel in 2 x 2"
    assert frames(0.01, 1)[:3] == [8, 8, 8]
    assert frames(0.2, 2) == [2, 2, 2, 2, 2]


@pytest.fixture
def clock() -> Clock:
    return Clock()


@pytest.fixture
def session(context: Context, clock: Clock) -> Iterator[Session]:
    scene = load("cornell")
    settings = settings_for(scene.render, width=32, height=24, bounces=2, samples=96)
    found = Session(scene, settings, context, clock)
    found.moving.use(Way("upsample"))
    with context.gl:
        start(found)
        found.advance(0.01, count=4)
        yield found
        found.release()


def drag(session: Session, aside: float = 0.2) -> None:
    """An edit whose picture has to be coarse."""
    session._preview._pixel_seconds = 1e-3  # of a machine that takes 0.8 s for a sample
    camera = replaced(session.scene.camera, position=(aside, 0.1, 2.5))
    session.edit(replaced(session.scene, camera=camera), "camera")
    session.advance(0.01)


@pytest.mark.slow
def test_a_drag_is_shown_at_full_size_and_gets_finer_until_the_film_follows(
    session: Session, clock: Clock
) -> None:
    """The distance of samples goes 8, 4, 2, 1, and pictures of each are shown."""
    drag(session)
    assert session.is_upsampled
    assert session.is_preview
    assert session.is_shown
    assert not session.is_reduced
    with pytest.raises(UsageError, match="no picture of all pixels yet"):
        session.image()
    steps = []
    while session.is_upsampled:
        with session.context.gl:
            shown = session.moving.texture(session.renderer, session.weights)  # type: ignore[arg-type]
        assert shown
        assert shown.size == (32, 24)
        steps.append(session.moving.progress[1])
        clock.now += STILL
        session._preview._pixel_seconds = 1e-3
        session.advance(0.01)
    assert list(dict.fromkeys(steps)) == [8, 4, 2]
    assert steps == sorted(steps, reverse=True)
    while not session.samples:
        session.advance(0.01)
    assert session.renderer
    assert session.renderer.settings.seed == session.settings.seed
    alone = Renderer(session.scene, session.settings, session.context)
    film = alone.render(session.samples).image().radiance
    assert same_bits(session.image().radiance, film), "the film has the bits of reset"
    alone.release()
    with session.context.gl:
        assert session.moving.texture(session.renderer, session.weights), "history goes on"


@pytest.mark.slow
@pytest.mark.parametrize(
    "edit", [{"method": "nee"}, {"bounces": 3}, {"roulette": False}, {"sampler": "independent"}]
)
def test_edits_of_the_transport_drop_the_history(
    session: Session, edit: dict[str, Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    drag(session)
    before: list[bool] = []
    arrive = Upsample.arrive

    def noted(self: Upsample, now: Any, old: Any, is_same_light: bool) -> None:
        before.append(old is not None)
        arrive(self, now, old, is_same_light)

    monkeypatch.setattr(Upsample, "arrive", noted)
    drag(session, 0.3)
    assert before == [True]
    session.edit(**edit)
    while len(before) < 2:
        session.advance(0.01)
    assert not before[1]


@pytest.mark.slow
@pytest.mark.parametrize("method", ["ddgi"])
def test_light_of_probes_is_shown_at_a_reduced_size(
    context: Context, clock: Clock, method: Method
) -> None:
    """Lattices know no probes: coarse pictures are then smaller ones, as by reproject."""
    scene = load("cornell")
    settings = settings_for(scene.render, width=32, height=24, bounces=2, method=method)
    found = Session(scene, settings, context, clock)
    found.moving.use(Way("upsample"))
    with context.gl:
        start(found)
        found.advance(0.01, count=2)
        drag(found)
        assert not found.is_upsampled
        assert found.is_reduced
        found.release()
