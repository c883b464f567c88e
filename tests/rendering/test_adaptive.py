"""Pictures by `adaptive = on`: pixels have counts of their own, and the bits of any render.

All use one scene and share a kernel with each other and with tests/rendering/test_shared.py.
"""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from glrt.comparison.verdict import compare
from glrt.core.errors import UsageError
from glrt.gpu.context import Context
from glrt.image.allotment import GROUP, counts_of, shares_of
from glrt.image.image import Image
from glrt.rendering.renderer import Renderer
from glrt.rendering.schedule import HEADLESS
from glrt.settings import Settings
from tests.rendering.test_shared import ROOM
from tests.support.images import same_bits
from tests.support.renders import assert_agree, same

SIZE: dict[str, Any] = {"width": 29, "height": 18, "sampler": "sobol", "adaptive": "on"}
FLOOR = 64


def opened(context: Context, **settings: Any) -> Renderer:
    return Renderer(ROOM, context=context, tier="complete", **{**SIZE, **settings})


def taken(context: Context, samples: int, **settings: Any) -> Image:
    """A picture of so many samples, on average."""
    renderer = opened(context, **settings)
    image = renderer.render(samples).image()
    renderer.release()
    return image


@pytest.fixture(scope="module")
def known() -> dict[int, Image]:
    return {}


@pytest.fixture
def adaptive(context: Context, known: dict[int, Image]) -> Image:
    """A picture of 160 samples on average."""
    if not known:
        known[160] = taken(context, 160)
    return known[160]


def test_each_pixel_has_the_bits_of_a_render_with_as_many_samples(
    context: Context, adaptive: Image
) -> None:
    counts = adaptive.counts
    assert len(np.unique(counts)) > 5
    renderer = opened(context, adaptive="off")
    for count in np.unique(counts):
        plain, pixels = renderer.render(int(count)).image(), counts == count
        assert same_bits(adaptive.radiance[pixels], plain.radiance[pixels])
        assert same_bits(adaptive.stderr[pixels], plain.stderr[pixels])
    renderer.release()


def test_samples_are_the_mean_of_counts(context: Context, adaptive: Image) -> None:
    assert adaptive.samples == 160
    assert -16 * GROUP < adaptive.counts.sum() / 2 - 160 * 29 * 9 <= 0
    assert adaptive.counts.min() >= FLOOR
    assert (adaptive.counts % 16 == 0).all()
    assert (taken(context, 40).counts == 40).all()


def test_counts_follow_from_the_floor_alone(context: Context, adaptive: Image) -> None:
    """Whatever came later: the floor is a render without adaptive sampling."""
    floor = taken(context, FLOOR, adaptive="off")
    assert floor.film_state is not None
    shares = shares_of(floor.radiance, floor.film_state.variance)
    assert np.array_equal(adaptive.counts, counts_of(shares, 160, Settings()))
    assert np.ptp(shares) > 1


@pytest.mark.parametrize("first", [5, 64, 75, 130])
def test_a_picture_that_is_rendered_on_is_the_file_of_one_render(
    context: Context, tmp_path: Path, first: int, adaptive: Image
) -> None:
    taken(context, first).save(tmp_path / "first.exr")
    begun = Image.load(tmp_path / "first.exr")
    renderer = opened(context).resume(begun)
    assert np.array_equal(renderer.image().counts, begun.counts)
    assert same_bits(renderer.image().stderr, begun.stderr)
    renderer.render(160).image().save(tmp_path / "on.exr")
    renderer.release()
    adaptive.save(tmp_path / "whole.exr")
    assert (tmp_path / "on.exr").read_bytes() == (tmp_path / "whole.exr").read_bytes()
    again = Image.load(tmp_path / "on.exr")
    assert np.array_equal(again.counts, adaptive.counts)


def test_samples_may_come_in_portions_of_any_size(context: Context, adaptive: Image) -> None:
    renderer = opened(context)
    for samples in (3, 50, 27, 16, 41, 23):
        renderer.step(samples)
    assert same(renderer.image(), adaptive)
    renderer.release()


def test_dispatches_of_a_frame_may_be_small(
    context: Context, adaptive: Image, monkeypatch: pytest.MonkeyPatch
) -> None:
    """One work group and three samples at a time, and a frame that begins again."""
    renderer = opened(context)
    renderer.render(FLOOR)
    renderer._tracer.most_samples = 3
    limits = HEADLESS._replace(limit=1e-9)
    for _ in range(20):
        renderer._work(96, limits, 1e-9)
    renderer._tracer.drop_frame()
    while renderer.samples < 160:
        renderer._work(160 - renderer.samples, limits, 1e-9)
    assert same(renderer.image(), adaptive)
    renderer.release()


def test_a_picture_before_the_end_of_a_frame_is_that_of_the_last_one(context: Context) -> None:
    renderer = opened(context)
    before = renderer.render(80).image()
    renderer._work(80, HEADLESS._replace(limit=1e-9), 1e-9)
    assert renderer.samples == 80
    assert same(renderer.image(), before)
    assert np.array_equal(renderer.image().counts, before.counts)
    renderer.restart()
    assert same(renderer.render(FLOOR).image(), taken(context, FLOOR, adaptive="off"))
    renderer.release()


def test_the_light_is_that_of_a_plain_render(context: Context) -> None:
    one, other = taken(context, 512, seed=1), taken(context, 512, seed=2, adaptive="off")
    assert_agree(one, other, within=0.1)
    assert one.error is not None
    assert other.error is not None
    assert one.error < other.error


def test_dropped_samples_are_those_of_each_pixel(context: Context) -> None:
    renderer = opened(context)
    assert renderer.render(160).nonfinite() == 0
    state = renderer.image().film_state
    assert state is not None
    assert not state.dropped.any()
    with context.gl:
        reading = renderer.reading(renderer.plan.weights, 3, 4)
    assert reading.samples == renderer.image().counts[4, 3]
    renderer.release()


def test_adaptive_pictures_are_compared_by_their_errors(context: Context) -> None:
    one, other = taken(context, 256, seed=1), taken(context, 256, seed=2)
    found = compare(one, other)
    assert not found.alike
    assert found.verdict != "different"
    one, other = taken(context, FLOOR, seed=1), taken(context, FLOOR, seed=2)
    assert compare(one, other).alike


def test_what_adaptive_sampling_does_not_go_with_is_refused_by_name(context: Context) -> None:
    for settings in (
        *({"crop": (0, 0, 9, 9)}, {"denoise": "nlm"}, {"aov": ("albedo",)}, {"method": "ddgi"}),
        *({"sampler": "shared"}, {"caustics": "on"}, {"part": (1, 2)}, {"layering": "groups"}),
        {"pipeline": "fragment"},
    ):
        with pytest.raises(UsageError, match="--adaptive on"):
            opened(context, **settings)
