"""The kept picture at the seeds and samples of the next one: what is equal differs by nothing."""

from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from glrt.gpu.context import Context
from glrt.rendering.renderer import Renderer
from glrt.scene.scene import Scene, with_lights
from glrt.settings import settings_for
from glrt.view.controls import replaced
from glrt.view.edits.edited_state import State
from glrt.view.state.reference_image import Kept, ReferenceImage
from glrt.view.state.session import ANNOUNCED, Session
from glrt.view.viewport.difference import difference_of
from glrt.view.viewport.picture_view import LONGER, PictureView
from tests.support.mixed_scene import everything
from tests.support.sessions import start

AS_KEPT = 7  # samples
SIZE: dict[str, int] = {"width": 16, "height": 12, "bounces": 3}
Floats = NDArray[np.float32]


@pytest.fixture
def next_one(context: Context) -> Iterator[Renderer]:
    """The picture that is compared with the kept one."""
    scene = everything()
    settings = settings_for(scene.render, **SIZE)
    renderer = Renderer(scene, settings, context, layering="groups")
    yield renderer.render(6)
    renderer.release()


@pytest.fixture
def kept(next_one: Renderer) -> Iterator[ReferenceImage]:
    """The picture as it was before any change, kept black and with samples of no other picture."""
    black = Kept(np.zeros((12, 16, 3), np.float32), AS_KEPT, next_one.settings.seed)
    picture = ReferenceImage(State(next_one.scene, next_one.settings), black, next_one.context)
    yield picture
    with next_one.context.gl:
        picture.release()


def repainted(scene: Scene) -> Scene:
    materials = dict(scene.materials)
    materials["brass"] = replaced(materials["brass"], color=(0.1, 0.8, 0.1))
    return replaced(scene, materials=materials)


def light(kept: ReferenceImage, other: Renderer) -> Floats:
    with other.context.gl:
        texture = kept.light(other)
        assert texture
        return np.frombuffer(texture.read(), np.float32).reshape(12, 16, 4)[..., :3]


def catch_up(kept: ReferenceImage, other: Renderer) -> None:
    for _ in range(ANNOUNCED + 10):  # frames
        kept.catch_up(other, 0.05)


def test_nothing_changed_and_nothing_differs(kept: ReferenceImage, next_one: Renderer) -> None:
    catch_up(kept, next_one)
    assert kept.samples(next_one) == next_one.samples
    assert kept._renderer is None, "one film shows both"
    assert (light(kept, next_one) == next_one.image().radiance).all()


def test_lamps_that_were_changed_are_weighed_back(kept: ReferenceImage, next_one: Renderer) -> None:
    before = next_one.image().radiance
    next_one.update(with_lights(next_one.scene, {"lamp": 2.0}))
    assert next_one.image().radiance.mean() > 1.3 * before.mean()
    catch_up(kept, next_one)
    assert kept._renderer is None
    assert np.allclose(light(kept, next_one), before, rtol=1e-5, atol=1e-7)


def test_another_material_differs_only_where_its_light_comes(
    kept: ReferenceImage, next_one: Renderer
) -> None:
    before = next_one.image().radiance
    next_one.update(repainted(next_one.scene))
    next_one.render(6)
    catch_up(kept, next_one)
    assert (light(kept, next_one) == before).all(), "at the same seeds and samples"
    after = next_one.image().radiance
    assert 0.1 < (after == before).all(axis=2).mean() < 0.9


def test_at_the_samples_that_it_was_kept_with_nothing_is_rendered_again(
    next_one: Renderer,
) -> None:
    before = next_one.image().radiance
    state, context = State(next_one.scene, next_one.settings), next_one.context
    kept = ReferenceImage(state, Kept(before, 6, state.settings.seed), context)
    next_one.update(repainted(next_one.scene))
    next_one.render(6)
    catch_up(kept, next_one)
    assert kept._renderer is None
    assert (light(kept, next_one) == before).all()
    assert kept.mean == pytest.approx(before.mean(), rel=1e-5)
    next_one.update(seed=state.settings.seed + 1)
    next_one.render(6)
    assert kept.samples(next_one) == 0, "other noise"
    next_one.update(seed=state.settings.seed)
    next_one.render(5)
    assert kept.light(next_one) is None
    with context.gl:
        assert kept.as_kept
        kept.take(state)
        assert kept.as_kept is None
        kept.release()


def test_it_waits_for_equal_samples(kept: ReferenceImage, next_one: Renderer) -> None:
    next_one.update(repainted(next_one.scene))
    next_one.render(6)
    kept.catch_up(next_one, 0.05)
    assert "Compiling" in kept.busy
    assert kept.light(next_one) is None
    catch_up(kept, next_one)
    assert kept.busy == ""
    next_one.render(9)
    assert kept.light(next_one) is None
    catch_up(kept, next_one)
    assert kept.samples(next_one) == 9
    next_one.restart()
    next_one.render(2)
    assert kept.light(next_one) is None
    catch_up(kept, next_one)
    assert kept.samples(next_one) == 2


def test_it_takes_the_seed_of_the_next_one(kept: ReferenceImage, next_one: Renderer) -> None:
    next_one.update(repainted(next_one.scene), seed=3)
    next_one.render(4)
    catch_up(kept, next_one)
    fresh = Renderer(kept.state.scene, kept.state.settings, next_one.context, seed=3)
    assert (light(kept, next_one) == fresh.render(4).image().radiance).all()
    fresh.release()
    next_one.update(seed=4)
    next_one.render(4)
    catch_up(kept, next_one)
    assert kept.samples(next_one) == 4
    assert kept._renderer is not None
    assert kept._renderer.settings.seed == 4


def test_another_size_does_not_fit(kept: ReferenceImage, next_one: Renderer) -> None:
    assert kept.fits(next_one)
    next_one.update(width=17)
    assert not kept.fits(next_one)


def test_at_rest_it_gives_its_film_back(kept: ReferenceImage, next_one: Renderer) -> None:
    next_one.update(repainted(next_one.scene))
    next_one.render(2)
    catch_up(kept, next_one)
    assert kept._renderer is not None
    kept.rest()
    assert kept._renderer is None
    assert kept.light(next_one) is None


def test_the_difference_is_reported_in_numbers(context: Context) -> None:
    """A twice as bright on the left half: the mean is 1/3 darker, half of the pixels by 1/2."""
    here = np.ones((4, 6, 4), np.float32)
    there = here.copy()
    there[:, :3, :3] = 2.0
    with context.gl:
        one, two = (context.gl.texture((6, 4), 4, a.tobytes(), dtype="f4") for a in (here, there))
        black = context.gl.texture((6, 4), 4, bytes(6 * 4 * 16), dtype="f4")
        found, same = difference_of(one, two, 8, 8), difference_of(one, one, 8, 8)
        dark, other = difference_of(one, black, 8, 8), difference_of(one, two, 8, 9)
    assert found.brighter == pytest.approx(-1 / 3)
    scale = 4 + 0.01 * 1.5**2
    assert found.pixels == pytest.approx((0.5 / scale) ** 0.5)
    assert found.told.startswith("B is 33.3 % darker, in the mean, than A; pixels differ by 35.3 %")
    assert (same.brighter, same.pixels) == (0, 0)
    assert same.told == "A and B are the same; 8 samples"
    assert dark.told == "A is black"
    assert other.told.endswith("with the noise of both: A has 9 samples, B 8")


class Behind:
    """Stands for a kept picture that has some samples; remembers how long it was to work."""

    def __init__(self, samples: int, as_kept: int = 0) -> None:
        self._samples, self.samples_as_kept = samples, as_kept
        self.turns: list[float] = []

    def fits(self, _: Renderer) -> bool:
        return True

    def samples(self, _: Renderer) -> int:
        return self._samples

    def catch_up(self, _: Renderer, seconds: float) -> None:
        self.turns.append(seconds)


@pytest.mark.parametrize(("samples", "share"), [(0, LONGER), (1000, 0.005)])
def test_a_picture_that_is_waited_for_gets_long_turns(
    session: Session, samples: int, share: float
) -> None:
    """Otherwise it takes a small share of a frame; nothing needs the rest of the frame."""
    nothing: Any = None
    show, kept = PictureView(nothing, nothing, nothing, nothing, nothing), Behind(samples)
    start(session)
    session.advance(0.01, 1)
    stand_in: Any = kept
    show.kept, show.view = stand_in, "difference"
    show.advance(session, 0.01, 1)
    assert kept.turns == [share]


def test_a_kept_picture_waits_until_the_other_one_is_done(session: Session) -> None:
    """At the samples that it was kept with, the other one is drawn on its way to more."""
    nothing: Any = None
    start(session)
    first, last = session.samples + 4, session.samples + 9
    session.edit(samples=last)
    show, kept = PictureView(nothing, nothing, nothing, nothing, nothing), Behind(0, first)
    stand_in: Any = kept
    show.kept, show.view = stand_in, "difference"
    seen = []
    for _ in range(100):
        if not session.is_done:
            show.advance(session, 10.0, 0)
            seen.append(session.samples)
    assert session.is_done
    assert seen[-2:] == [first, last]
    assert kept.turns == []
    show.advance(session, 0.01, 0)
    assert kept.turns == [LONGER]
