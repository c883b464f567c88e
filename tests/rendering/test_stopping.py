"""When a render to an error looks at it: where the forecast says, at the next doubling at last."""

import pytest

from glrt.gpu.context import Context
from glrt.rendering.stopping import Interruption, Limits, first_look, look_after, render_to_limit
from glrt.settings import Settings
from tests.shaders.test_sobol import lit
from tests.support.renders import rendering

TO_2 = Limits(1 << 20, error=0.02)


@pytest.mark.parametrize(
    ("samples", "error", "look"),
    [
        (64, 0.04, 128),  # 261 are needed
        (64, 0.025, 112),  # 102 are
        (64, 0.02001, 80),
        (112, 0.0201, 128),
        (1024, 0.0205, 1104),
        (64, None, 128),
    ],
)
def test_the_next_look_is_where_the_error_will_be_reached(
    samples: int, error: float | None, look: int
) -> None:
    assert look_after(samples, error, TO_2, Settings()) == look


def test_looks_end_at_whole_blocks_and_at_the_last_sample() -> None:
    assert look_after(512, 0.025, TO_2, Settings(sampler="sobol256")) == 1024
    assert look_after(1024, 0.025, TO_2, Settings(sampler="sobol256")) == 1792
    assert look_after(64, 0.022, TO_2, Settings(sampler="independent")) == 79
    assert look_after(64, 0.4, Limits(100, error=0.02), Settings()) == 100


def test_denoised_pictures_are_looked_at_at_doublings() -> None:
    """Their first halves are kept there."""
    assert look_after(64, 0.025, TO_2, Settings(denoise="nlm")) == 128


def test_a_picture_that_is_rendered_on_is_looked_at_where_one_render_might() -> None:
    assert [first_look(TO_2, begun) for begun in (0, 64, 65, 300)] == [64, 64, 128, 512]
    assert first_look(Limits(50, error=0.02), 0) == 50
    assert first_look(Limits(500), 0) == 500


def test_a_render_ends_soon_after_its_error_is_reached(context: Context) -> None:
    """With looks at doublings alone it ended at 256 samples."""
    with rendering(lit(), context, sampler="sobol", width=32, height=32) as renderer:
        error = renderer.render(160).image().error
        assert error
        renderer.restart()
        found = render_to_limit(renderer, Limits(1 << 12, error=error), Interruption())
    assert found
    assert found.error
    assert found.error <= error
    assert 144 <= found.samples <= 176
