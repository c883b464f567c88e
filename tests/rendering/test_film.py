"""The film: textures that change places, and the standard error of what they hold."""

import tracemalloc
from collections.abc import Callable, Iterator
from typing import Any

import moderngl
import numpy as np
import pytest

from glrt.core.errors import RenderError
from glrt.gpu.context import Context
from glrt.gpu.glsl import Source
from glrt.gpu.program import Kernel
from glrt.gpu.struct_arrays import FILE
from glrt.image.film_state import empty_state
from glrt.image.sources import load
from glrt.packing.scene_arrays import Dispatch, pack_frame
from glrt.plan.plan import prepare
from glrt.rendering.film import Exposure, Extent, Film, standard_error
from glrt.rendering.pipelines import scene_text, upload
from glrt.settings import settings_for
from tests.support.builders import lamp, scene_of, sphere
from tests.support.numerics import Array
from tests.support.packed import packed
from tests.support.renders import rendering

ONE = np.ones(3, np.float32)
WIDTH, HEIGHT = 12, 7
ROOM = scene_of(  # a bright ball before a dim sky: pixels differ, and samples along its rim
    [sphere([0.2, 0.1, -3], 0.8, "lamp")],
    {"lamp": lamp(2.0)},
    background={"color": [0.25, 0.5, 1.0]},
    render={"width": WIDTH, "height": HEIGHT, "bounces": 1},
)

# --- textures ------------------------------------------------------------------------------

Step = Callable[[Film, int], None]


@pytest.fixture
def step(ctx: moderngl.Context) -> Iterator[Step]:
    """`step(film, samples)`: one dispatch of the kernel for ROOM, and the swap after it."""
    settings = settings_for(ROOM.render, sampler="independent")
    plan, arrays = prepare(ROOM, settings), packed(ROOM)
    counts = {struct: len(rows) for struct, rows in arrays.items()}
    texts = {FILE: scene_text(ctx, arrays, "generic")}
    kernel = Kernel(ctx, Source("trace.comp", plan.needs.constants(), texts=texts))
    buffers = {**upload(ctx, arrays, "generic"), "Lost": ctx.buffer(bytes(4))}

    def dispatch(film: Film, samples: int) -> None:
        now = Dispatch(film.next_sample, samples, is_empty=not film.samples)
        frame = pack_frame(plan, counts, now, None)
        buffers["FrameBlock"] = ctx.buffer(frame)
        kernel.bind(buffers, film.images())
        kernel.run(WIDTH, HEIGHT)
        film.advance(samples)
        buffers["FrameBlock"].release()

    yield dispatch
    kernel.release()
    for buffer in buffers.values():
        buffer.release()


@pytest.fixture
def film(ctx: moderngl.Context) -> Iterator[Film]:
    """A film of ROOM's size whose textures hold nothing but NaN."""
    film = Film(ctx, Extent(WIDTH, HEIGHT))
    poison(film)
    yield film
    film.release()


def poison(film: Film) -> None:
    for texture in film.images().values():
        texture.write(np.full((HEIGHT, WIDTH, 4), np.nan, np.float32))


def assert_same(a: Exposure, b: Exposure) -> None:
    for x, y in zip(a, b, strict=True):
        assert np.array_equal(x, y)


def test_the_first_sample_ignores_what_the_textures_hold(film: Film, step: Step) -> None:
    step(film, 1)
    first = film.read()
    assert np.all(np.isfinite(first.mean))  # PT2
    assert np.all(first.variance == 0)
    assert np.all(first.dropped == 0)
    assert len(np.unique(first.mean[..., 0])) == 2  # ball and sky
    step(film, 3)
    assert np.all(np.isfinite(film.read().mean))


def test_a_restart_ignores_what_was_gathered(film: Film, step: Step) -> None:
    step(film, 2)
    fresh = film.read()
    step(film, 5)
    film.restart()
    poison(film)
    step(film, 2)
    assert_same(film.read(), fresh)


def test_later_samples_do_read_the_source(film: Film, step: Step) -> None:
    step(film, 1)
    poison(film)
    step(film, 1)
    assert np.all(np.isnan(film.read().mean))


def test_one_dispatch_of_many_samples_equals_many_of_one(film: Film, step: Step) -> None:
    step(film, 16)
    together = film.read()
    film.restart()
    for count in (1, 1, 5, 8, 1):
        step(film, count)
    assert film.samples == 16
    assert_same(film.read(), together)


def test_source_and_target_change_places_once_a_frame(film: Film, step: Step) -> None:
    for _ in range(3):
        before = film.images()
        step(film, 1)
        after = film.images()
        for kind in ("mean", "variance"):
            assert after[f"source_{kind}"] is before[f"target_{kind}"]
            assert after[f"target_{kind}"] is before[f"source_{kind}"]
        assert film.mean is after["source_mean"]


def test_a_frame_writes_its_target_and_leaves_its_source(film: Film, step: Step) -> None:
    step(film, 1)
    source = film.images()["source_mean"]
    before = source.read()
    step(film, 1)
    assert source.read() == before
    assert film.mean.read() != before


def test_row_0_is_the_top_of_the_picture(film: Film, step: Step) -> None:
    step(film, 64)
    lit = film.read().mean[..., 0] > 0.3
    rows, columns = np.nonzero(lit)
    assert film.read().mean.shape == (HEIGHT, WIDTH, 3)
    assert rows.mean() < (HEIGHT - 1) / 2  # the ball lies above the middle, to the right
    assert columns.mean() > (WIDTH - 1) / 2


def test_a_film_that_finds_no_room_gives_back_what_it_has_taken(
    ctx: moderngl.Context, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The means fit, but the layers next to each other are wider than any texture."""
    taken: list[moderngl.Texture] = []
    make = ctx.texture

    def texture(*given: Any, **more: Any) -> moderngl.Texture:
        taken.append(make(*given, **more))
        return taken[-1]

    monkeypatch.setattr(moderngl.Context, "texture", staticmethod(texture))
    with pytest.raises(RenderError, match=r"allows .* along an edge"):
        Film(ctx, Extent(ctx.info["GL_MAX_TEXTURE_SIZE"] // 2, 1, layers=3))
    assert len(taken) == 2
    assert all(isinstance(found.mglo, moderngl.InvalidObject) for found in taken)


def test_dropped_samples_are_counted_to_the_last_one(film: Film) -> None:
    """Their sum over the pixels has more digits than a float32."""
    dropped = np.arange(2.0**20 - WIDTH * HEIGHT, 2.0**20, dtype=np.float32)
    nothing = empty_state(HEIGHT, WIDTH)._replace(dropped=dropped.reshape(HEIGHT, WIDTH))
    film.write(1 << 20, np.zeros((HEIGHT, WIDTH, 3), np.float32), nothing)
    assert film.dropped() == int(dropped.sum(dtype=np.float64))


def test_rows_of_a_film_are_those_of_the_whole(film: Film, step: Step) -> None:
    step(film, 3)
    whole = film.read()
    for rows in (slice(0, 1), slice(2, HEIGHT), slice(None, 3), slice(HEIGHT - 1, HEIGHT + 9)):
        part = film.read(rows)
        for name in ("mean", "variance", "dropped", "observations", "part", "share"):
            assert np.array_equal(getattr(part, name), getattr(whole, name)[rows])


@pytest.mark.slow
def test_reading_a_picture_takes_little_memory_next_to_it(
    context: Context, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The peak memory of numpy and moderngl, as Python counts it."""
    monkeypatch.setattr("glrt.rendering.film.BAND_PIXELS", 1 << 12)
    monkeypatch.setattr("glrt.error.estimate.BAND", 1 << 12)
    with rendering(load("sky"), context, width=512, height=256) as renderer:
        renderer.render(32)
        tracemalloc.start()
        image = renderer.image()
        error = image.error
        held, peak = tracemalloc.get_traced_memory()
        tracemalloc.stop()
    assert error
    assert image.film_state
    size = sum(array.nbytes for array in (image.radiance, image.stderr, *image.film_state))
    assert size <= held <= peak < 1.15 * size


def test_an_empty_film_can_not_be_read(film: Film, step: Step) -> None:
    with pytest.raises(RenderError, match="empty"):
        film.read()
    step(film, 1)
    film.restart()
    with pytest.raises(RenderError, match="empty"):
        film.read()


def test_a_film_too_large_for_the_driver_is_refused(ctx: moderngl.Context) -> None:
    with pytest.raises(RenderError, match="takes a texture of 1,000,000 x 1 texels"):
        Film(ctx, Extent(1_000_000, 1))


# --- standard error ------------------------------------------------------------------------


def exposure(samples: Array, dropped: int = 0, part: Array = ONE, share: float = 0) -> Exposure:
    """A film of a row of pixels: these observations, (n, width, 3) or (n, 3), and a part of one."""
    samples = samples.reshape(len(samples), 1, -1, 3)
    pixels = samples.shape[1:3]
    return Exposure(
        mean=(1 - share) * samples.mean(axis=0) + share * part,
        variance=samples.var(axis=0),
        dropped=np.full(pixels, np.float32(dropped)),
        observations=np.full(pixels, np.float32(len(samples))),
        part=np.broadcast_to(part, (*pixels, 3)),
        share=np.full(pixels, np.float32(share)),
        layers=np.zeros((2, 0, *pixels, 4), np.float32),
    )


def test_the_standard_error_is_that_of_the_mean() -> None:
    samples = np.random.default_rng(1).exponential(size=(50, 3)).astype(np.float32)
    exact = samples.std(axis=0, ddof=1) / np.sqrt(50)
    assert standard_error(exposure(samples))[0, 0] == pytest.approx(exact, rel=1e-6)
    assert standard_error(exposure(samples, dropped=3))[0, 0] == pytest.approx(exact, rel=1e-6)


def test_a_part_of_an_observation_has_a_variance_of_its_own() -> None:
    """Whatever it is: the mean of the estimates is the variance of the means."""
    random = np.random.default_rng(2)
    blocks = random.normal(5, 1, size=(3, 20_000, 3)).astype(np.float32)
    for spread in (0.5, 1, 4):
        parts = random.normal(5, spread, size=(20_000, 3)).astype(np.float32)
        film = exposure(blocks, part=parts, share=0.2)
        estimate = np.mean(np.square(standard_error(film)))
        # 60,000 estimates of at most three degrees of freedom: 0.6 % is one standard error.
        assert estimate == pytest.approx(0.64 / 3 + 0.04 * spread**2, rel=0.03)
        assert estimate == pytest.approx(np.var(film.mean), rel=0.04)


def test_fewer_than_two_observations_have_no_standard_error() -> None:
    one = np.ones((1, 3), np.float32)
    assert np.all(np.isnan(standard_error(exposure(one))))
    assert np.all(np.isnan(standard_error(exposure(one, dropped=4))))
    assert np.all(standard_error(exposure(np.ones((2, 3), np.float32))) == 0)
