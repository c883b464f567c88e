"""The view of the denoised picture: what `--denoise` makes, at doublings; no window is opened."""

import sys
import time
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

from glrt.denoise.filters import FILTERS, with_filter
from glrt.gpu.context import Context
from glrt.image.image import Image
from glrt.image.sources import load
from glrt.rendering.renderer import Renderer
from glrt.scene.materials.light import Light
from glrt.scene.scene import Scene
from glrt.settings import Cost, Settings, settings_for
from glrt.view.state import denoise_process
from glrt.view.state.denoised_picture import DenoisedPicture
from glrt.view.state.session import Session

SIZE: dict[str, Any] = {"width": 32, "height": 32}
SLEEPS = "import time; time.sleep(10**6)"


@pytest.fixture(params=["cornell", "lamps"], ids=["one film", "a film with layers"])
def session(request: pytest.FixtureRequest, context: Context) -> Iterator[Session]:
    scene = load(request.param)
    opened = Session(scene, settings_for(scene.render, **SIZE, samples=256), context)
    yield opened
    opened.release()


@pytest.fixture
def denoised() -> Iterator[DenoisedPicture]:
    picture = DenoisedPicture()
    yield picture
    picture.release()


def frame(session: Session, denoised: DenoisedPicture) -> None:
    """Do a frame of a view of the denoised picture, as `PictureView` does."""
    session.aovs = "albedo", "normal"
    session.stop = denoised.stop(session)
    session.advance(0.05, 24)
    denoised.follow(session)
    time.sleep(0.001)


def found(session: Session, denoised: DenoisedPicture, samples: int) -> Image:
    """The picture of so many samples."""
    for _ in range(20_000):
        frame(session, denoised)
        if denoised.found and denoised.found.samples == samples and not denoised.is_under_way:
            return denoised.found
    pytest.fail(denoised.told(session))


def expected(session: Session, samples: int) -> Image:
    """The image of a render without a window."""
    settings = settings_for(session.settings, samples=samples, denoise="auto")
    renderer = Renderer(session.scene, settings, session.context)
    return renderer.render().image()


def assert_same(image: Image, other: Image) -> None:
    assert image.denoising
    assert other.denoising
    np.testing.assert_array_equal(image.denoising.radiance, other.denoising.radiance)
    np.testing.assert_array_equal(image.denoising.error_map, other.denoising.error_map)
    assert image.denoising.error == other.denoising.error


@pytest.mark.slow
@pytest.mark.slow_cases("a film with layers")
def test_it_is_what_a_render_makes(session: Session, denoised: DenoisedPicture) -> None:
    """It is the same to the bit, at each doubling that there is time for, and at the end."""
    last = found(session, denoised, 256)
    assert session.is_done
    assert_same(last, expected(session, 256))
    name = with_filter(Settings(denoise="auto")).denoise
    assert name in FILTERS
    assert f"256 samples by {name}: error" in denoised.told(session)


@pytest.mark.slow
def test_an_edit_begins_again(session: Session, denoised: DenoisedPicture) -> None:
    session.edit(samples=64)
    first = found(session, denoised, 64)
    session.edit(bounces=2)
    frame(session, denoised)
    assert denoised.found is None
    assert_same(found(session, denoised, 64), expected(session, 64))
    assert first.recipe
    assert first.recipe.settings.bounces != 2


@pytest.mark.slow
def test_a_picture_that_is_there_is_the_first_half(
    session: Session, denoised: DenoisedPicture
) -> None:
    """It is filtered once a fifth of its samples came later, and not before."""
    while session.samples < 160:
        session.advance(0.05, 160 - session.samples)
    while not (session.samples > 160 and denoised.is_under_way):
        assert denoised.found is None
        frame(session, denoised)
    for _ in range(20_000):
        frame(session, denoised)
        if denoised.found:
            break
    assert denoised.found
    assert 200 <= denoised.found.samples < 232
    assert denoised.found.denoising
    plain = denoised.found.denoising.error
    assert 0 < plain < 0.5


def test_without_samples_to_come_it_says_what_to_do(
    session: Session, denoised: DenoisedPicture
) -> None:
    while not session.is_done:
        session.advance(0.05, 64)
    for _ in range(4):
        frame(session, denoised)
    assert denoised.found is None
    assert not denoised.is_under_way
    assert "restart" in denoised.told(session)


def test_a_filter_that_is_under_way_is_ended_and_not_waited_for(
    session: Session, denoised: DenoisedPicture, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It would take days."""
    monkeypatch.setattr(denoise_process, "COMMAND", [sys.executable, "-c", SLEEPS])
    while not denoised.is_under_way:
        frame(session, denoised)
    denoised.release()
    assert denoised.found is None


def test_a_filter_that_fails_is_reported(
    session: Session, denoised: DenoisedPicture, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(denoise_process, "COMMAND", [sys.executable, "-c", "raise MemoryError"])
    while "ended without a picture" not in denoised.told(session):
        frame(session, denoised)
    assert not denoised.fits(session)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["cornell", "lamps"], ids=["one film", "a film with layers"])
def test_relit_lamps_are_denoised_by_their_weights(
    name: str, context: Context, denoised: DenoisedPicture
) -> None:
    """The weighted sum: as bright as a render of the dimmed scene, and its error is known."""
    scene = load(name)
    session = Session(scene, settings_for(scene.render, **SIZE, samples=256), context)
    while session.samples < 16:
        session.advance(0.05, 1)
    session.edit(dimmed(scene))
    frame(session, denoised)
    assert session.last_cost is Cost.RELIGHT
    last = found(session, denoised, 256)
    session.release()
    renderer = Renderer(dimmed(scene), session.settings, context, samples=4096, seed=9)
    truth = renderer.render().image().radiance.astype(np.float64)
    renderer.release()
    assert last.denoising
    assert last.sums is None
    shown = last.denoising.radiance
    assert shown.mean() == pytest.approx(truth.mean(), rel=0.03)
    scale = np.square(truth) + 0.01 * truth.mean() ** 2
    error = float(np.sqrt((np.square(shown - truth) / scale).mean()))
    plain = float(np.sqrt((np.square(last.radiance - truth) / scale).mean()))
    assert error < plain
    assert last.denoising.error == pytest.approx(error, rel=0.35)


def dimmed(scene: Scene) -> Scene:
    """The scene with lamps of a quarter of their light."""
    materials = {
        name: material.model_copy(update={"emission": tuple(e / 4 for e in material.emission)})
        if isinstance(material, Light)
        else material
        for name, material in scene.materials.items()
    }
    return scene.model_copy(update={"materials": materials})
