"""`denoise`: the film goes on as ever, and half of it is kept as it passes by."""

from dataclasses import replace
from typing import Any, NamedTuple, cast

import numpy as np
import pytest

from glrt import Image, Renderer, load
from glrt.core.errors import UsageError
from glrt.denoise.denoising import denoise
from glrt.gpu.context import Context
from glrt.image.halves import halves_of
from glrt.rendering.first_half import Halver
from glrt.rendering.stopping import Interruption, Limits, render_to_limit
from glrt.settings import Settings
from tests.support.images import same_bits
from tests.support.renders import same

SIZE: dict[str, Any] = {"width": 24, "height": 16, "bounces": 4}
SETTINGS = Settings(denoise="nlm", **SIZE)


def renderer(context: Context, **settings: Any) -> Renderer:
    return Renderer(load("cornell"), None, context, "complete", **{**SIZE, **settings})


def rendered(context: Context, **settings: Any) -> Image:
    one = renderer(context, **settings)
    try:
        return one.render().image()
    finally:
        one.release()


def test_the_plain_picture_keeps_its_bits(context: Context) -> None:
    plain = rendered(context, samples=72)
    image = rendered(context, samples=72, denoise="nlm")
    assert same(image, plain)
    assert not image.aovs
    assert image.recipe
    assert image.recipe.settings.denoise == "nlm"
    assert plain.denoising is None
    with pytest.raises(UsageError, match="was not denoised"):
        plain.denoised()


def test_what_is_shown_is_made_of_the_middle_and_the_end(context: Context) -> None:
    wanted = rendered(context, samples=128, denoise="nlm").denoised()
    by_hand = renderer(context, samples=128, aov=("albedo", "normal"))
    first = by_hand.render(64).image()
    found = denoise(halves_of(first, by_hand.render().image()), "nlm")
    by_hand.release()
    assert same_bits(found.radiance, wanted.radiance)
    assert same_bits(found.error_map, wanted.error_map)
    assert found.error == wanted.error


def test_aovs_that_are_asked_for_are_kept_alongside(context: Context) -> None:
    image = rendered(context, samples=64, denoise="nlm", aov=("depth", "normal"))
    assert [*image.aovs] == ["normal", "depth"]
    without = rendered(context, samples=64, aov=("depth", "normal"))
    for name, aov in image.aovs.items():
        assert same_bits(aov.value, without.aovs[name].value)


class Fake(NamedTuple):
    """All that is asked of a picture that is kept."""

    samples: int


def kept(settings: Settings, *targets: int, begun: int = 0) -> list[int]:
    """Where a render keeps its picture on its way to one target after the other."""
    halver, samples, found = Halver(), begun, []
    for target in targets:
        while samples < target:
            if halver.wants(settings, samples, target):
                found.append(samples)
                halver.keep(cast(Image, Fake(samples)))
            samples = halver.next_stop(settings, samples, target)
    return found


def test_a_render_keeps_its_middle_and_doublings() -> None:
    assert kept(SETTINGS, 64) == [32]
    assert kept(SETTINGS, 200) == [32, 64, 96, 128]
    assert kept(SETTINGS.model_copy(update={"sampler": "independent"}), 10) == [2, 4, 5, 8]


def test_looks_at_doublings_have_their_middle() -> None:
    assert kept(SETTINGS, 64, 128, 256, 512) == [32, 64, 128, 256]
    assert kept(SETTINGS, 1, 2, 3, 40, 41, 65) == [32, 64]


def test_what_goes_on_is_kept_at_its_first_whole_observation() -> None:
    assert kept(SETTINGS, 160, begun=90) == [96, 128]
    assert kept(SETTINGS, 160, begun=112) == [112, 128]


def test_without_a_denoiser_nothing_stops_it() -> None:
    plain = SETTINGS.model_copy(update={"denoise": "none"})
    assert Halver().next_stop(plain, 0, 1 << 20) == 1 << 20


def test_a_render_that_ends_anywhere_is_denoised(context: Context) -> None:
    """This holds from 64 samples on; before, there is only the plain picture."""
    one = renderer(context, samples=1 << 12, denoise="nlm")
    for samples in (40, 63, 64, 100, 150, 333):
        image = one.render(samples).image()
        assert (image.denoising is not None) == (samples >= 64), samples
        assert image.error_to_reach == (
            image.denoising.error_high if image.denoising else image.error
        )
    one.release()


def test_another_edit_forgets_what_was_kept(context: Context) -> None:
    one = renderer(context, samples=64, denoise="nlm")
    one.render()
    one.update(seed=5)
    found = one.render().image()
    one.release()
    assert same_bits(found.shown, rendered(context, samples=64, denoise="nlm", seed=5).shown)


def test_an_error_that_is_asked_for_is_that_of_what_is_shown(context: Context) -> None:
    one = renderer(context, samples=1 << 14, denoise="nlm")
    plain = one.render(64).image()
    assert plain.error
    wanted = 0.8 * plain.error
    one.restart()
    image = render_to_limit(one, Limits(1 << 14, error=wanted), Interruption())
    one.release()
    assert image
    assert image.error_to_reach is not None
    assert image.error_to_reach <= wanted
    assert image.error
    assert image.samples == 64 or image.error > wanted / 2


def test_a_picture_goes_on_where_it_was_not_denoised(context: Context) -> None:
    """Even from inside an observation: the next whole one is the half then."""
    begun = rendered(context, samples=90)
    one = renderer(context, samples=128, denoise="nlm").resume(begun)
    image = one.render().image()
    one.release()
    assert image.denoising
    assert same(image, rendered(context, samples=128))


def test_too_little_to_go_on_with_is_refused(context: Context) -> None:
    begun = rendered(context, samples=90)
    one = renderer(context, samples=120, denoise="nlm")
    with pytest.raises(UsageError, match="needs --samples 128 at least"):
        one.resume(begun)
    one.release()


@pytest.mark.parametrize(("sampler", "least"), [("sobol", 64), ("independent", 4)])
def test_too_few_samples_are_refused(sampler: Any, least: int) -> None:
    with pytest.raises(UsageError, match=f"--denoise needs {least} samples a pixel"):
        Renderer(load("cornell"), denoise="nlm", sampler=sampler, samples=least - 1)


def test_files_hold_both_pictures(context: Context, tmp_path: Any) -> None:
    image = rendered(context, samples=64, denoise="nlm")
    image.save(tmp_path / "a.exr")
    found = Image.load(tmp_path / "a.exr")
    assert same(found, image)
    assert same_bits(found.denoised().radiance, image.denoised().radiance)
    assert same_bits(found.denoised().error_map, image.denoised().error_map)
    assert found.denoised().error == pytest.approx(image.denoised().error, rel=1e-6)
    image.save(tmp_path / "a.npy")
    assert same_bits(np.load(tmp_path / "a.npy"), image.denoised().radiance)
    image.save(tmp_path / "a.png")
    replace(image, radiance=image.denoised().radiance, denoising=None).save(tmp_path / "b.png")
    from PIL import Image as Pillow

    with Pillow.open(tmp_path / "a.png") as a, Pillow.open(tmp_path / "b.png") as b:
        assert np.array_equal(np.asarray(a), np.asarray(b))
