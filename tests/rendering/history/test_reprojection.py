"""Where history comes from: pans in closed form, what is hidden and what is another surface."""

import math

import numpy as np
import pytest

from glrt.analysis.motion.playing import read_texture
from glrt.gpu.context import Context
from glrt.rendering.history.reprojection import Limits, Reprojection, shares_objects
from glrt.scene.scene import Scene
from tests.support.builders import MATTE, glass, lamp, plane, quad, scene_of, sphere
from tests.support.moving import FOV, UNLIMITED, brought, noise, two_walls, view, wall

SIZE = (32, 24)
PIXEL = 1.0 / SIZE[1]  # of the wall, whose height the picture has
CAMERA = {"position": [0.0, 0.0, 1.0], "look_at": [0.0, 0.0, 0.0], "fov": FOV}


@pytest.mark.parametrize(("right", "down"), [(0, 0), (3, 0), (-5, 2), (0, -7)])
def test_a_pan_by_whole_pixels_keeps_every_bit(context: Context, right: int, down: int) -> None:
    """The columns and rows that come into sight have no history."""
    history = noise(SIZE)
    found = brought(wall(), wall(right * PIXEL, -down * PIXEL), history, context)
    columns, rows = np.arange(SIZE[0]) + right, np.arange(SIZE[1]) + down
    is_seen = ((rows >= 0) & (rows < SIZE[1]))[:, None] & ((columns >= 0) & (columns < SIZE[0]))
    assert np.array_equal(found[..., 3] > 0, is_seen)
    moved = np.roll(history, (-down, -right), axis=(0, 1))
    assert np.array_equal(found[is_seen], moved[is_seen])


@pytest.mark.parametrize("share", [0.25, 0.5])
def test_between_pixels_it_is_exact_for_a_parabola(context: Context, share: float) -> None:
    """Catmull and Rom's spline is exact there, but no mean of neighbours is."""
    x, y = np.meshgrid(np.arange(SIZE[0]) + 0.5, np.arange(SIZE[1]) + 0.5)
    history = np.ones((SIZE[1], SIZE[0], 4))

    def light(x: np.ndarray, y: np.ndarray) -> np.ndarray:
        return (x / 32) ** 2 + (y / 24) * (x / 32) - (y / 24) ** 2

    history[..., 0] = light(x, y)
    found = brought(wall(), wall(share * PIXEL, share * PIXEL), history, context)
    truth = light(x + share, y - share)
    inner = slice(3, -3), slice(3, -3)
    np.testing.assert_allclose(found[..., 0][inner], truth[inner], atol=2e-5)


def test_half_a_pixel_many_times_keeps_detail(context: Context) -> None:
    """The view moves to and fro: a wave of 8 pixels loses the spline's response each time."""
    waves, turns = 2 * math.pi / 8, 100
    x = np.arange(64) + 0.5
    history = np.ones((16, 64, 4), np.float32)
    history[..., 0] = 1 + np.sin(waves * x)
    with view(wall(), context, (64, 16)) as here, view(wall(0.5 / 16), context, (64, 16)) as there:
        reprojection = Reprojection(context.gl, UNLIMITED)
        with context.gl:
            first = context.gl.texture((64, 16), 4, history.tobytes(), dtype="f4")
            shown = first
            for _ in range(turns // 2):
                shown = reprojection.bring(there, here, shown)
                shown = reprojection.bring(here, there, shown)
            history = read_texture(shown).copy()
            first.release()
            reprojection.release()
    gain = 9 / 8 * math.cos(waves / 2) - 1 / 8 * math.cos(3 * waves / 2)
    inner = slice(24, 40)  # two waves, away from what has come into sight
    wave = history[8, inner, 0] - 1
    amplitude = 2 * np.mean(wave * np.sin(waves * x[inner]))
    assert amplitude == pytest.approx(gain**turns, abs=0.005)
    assert amplitude > 0.4  # linear interpolation leaves cos(pi / 8)^100 = 0.0004


def test_samples_between_pixels_are_those_of_their_harmonic_mean(context: Context) -> None:
    """Otherwise the variance of a mean would be estimated too low."""
    history = np.ones((SIZE[1], SIZE[0], 4), np.float32)
    history[:, ::2, 3] = 4.0
    history[:, 1::2, 3] = 16.0
    found = brought(wall(), wall(0.5 * PIXEL), history, context)
    np.testing.assert_allclose(found[4:-4, 4:-4, 3], 2 / (1 / 4 + 1 / 16), rtol=1e-3)


# --- what has no history -----------------------------------------------------------------------


def test_what_was_hidden_has_no_history(context: Context) -> None:
    """The camera goes right by 4 pixels of the wall, so the quad goes left by 8 in the picture.

    The parallax uncovers a band of the wall next to it, 4 pixels wide.
    """
    history = noise(SIZE)
    found = brought(two_walls(0.0), two_walls(4 * PIXEL), history, context)
    has_none = (found[..., 3] == 0).all(axis=0)
    edge = SIZE[0] // 2 - 8
    band = np.arange(edge, edge + 4)
    assert has_none[band].all()
    assert not has_none[: edge - 1].any()
    assert not has_none[edge + 6 : -5].any()  # pixels at an edge give theirs to such alone
    assert not (found[..., 3] == 0).any(axis=0)[edge + 6 : -5].any()


@pytest.fixture
def _motion_is_unknown(monkeypatch: pytest.MonkeyPatch) -> None:
    """As of a mesh whose vertices moved."""
    monkeypatch.setattr("glrt.rendering.history.motion.moved_objects", lambda now, before: [])


@pytest.mark.usefixtures("_motion_is_unknown")
def test_another_object_in_its_place_gives_nothing(context: Context) -> None:
    """A wall of two parts, whose seam moves by 6 pixels: what lies between is another one's now."""

    def scene(seam: float) -> Scene:
        parts = [quad([x, -4, 0], [4, 0, 0], [0, 8, 0], "matte") for x in (seam - 4, seam)]
        return scene_of(parts, {"matte": MATTE}, CAMERA)

    found = brought(scene(0.0), scene(6 * PIXEL), noise(SIZE), context)
    middle = SIZE[0] // 2
    assert (found[:, middle : middle + 6, 3] == 0).all()
    assert (found[:, : middle - 1, 3] > 0).all()
    assert (found[:, middle + 7 :, 3] > 0).all()


@pytest.mark.usefixtures("_motion_is_unknown")
def test_a_surface_that_has_turned_gives_nothing(context: Context) -> None:
    """It turns by more than 25 degrees; the place on the axis of the turn stays the same."""

    def scene(degrees: float) -> Scene:
        angle = math.radians(degrees)
        normal = [math.sin(angle), 0, math.cos(angle)]
        return scene_of([plane([0, 0, 0], normal, "matte")], {"matte": MATTE}, CAMERA)

    middle = slice(SIZE[0] // 2 - 1, SIZE[0] // 2 + 1)
    for degrees, is_kept in ((20, True), (30, False)):
        found = brought(scene(0), scene(degrees), noise(SIZE), context)
        assert (found[:, middle, 3] > 0).all() == is_kept
        assert (found[:, middle, 3] > 0).any() == is_kept


@pytest.mark.usefixtures("_motion_is_unknown")
def test_a_surface_that_has_come_nearer_gives_nothing(context: Context) -> None:
    """It has come nearer by more than 2 % of its distance."""

    def scene(nearer: float) -> Scene:
        return scene_of([plane([0, 0, nearer], [0, 0, 1], "matte")], {"matte": MATTE}, CAMERA)

    for nearer, is_kept in ((0.015, True), (0.03, False)):
        found = brought(scene(0.0), scene(nearer), noise(SIZE), context)
        assert (found[..., 3] > 0).all() == is_kept
        assert (found[..., 3] > 0).any() == is_kept


def test_a_sky_follows_the_directions(context: Context) -> None:
    """Nothing is infinitely far: the eye may go anywhere."""
    one, other = (
        scene_of(
            [],
            {},
            {**CAMERA, "position": place, "look_at": [place[0], 0, -5]},
            background={"color": [1.0, 1.0, 1.0]},
        )
        for place in ([0.0, 0.0, 1.0], [7.0, 0.0, 1.0])
    )
    history = noise(SIZE)
    assert np.array_equal(brought(one, other, history, context), history)


# --- how much it counts ------------------------------------------------------------------------


def test_it_counts_for_less_where_its_motion_is_wrong(context: Context) -> None:
    """Its motion is wrong in glass and at edges; at the edge of a lamp it counts for nothing."""
    materials = {"matte": MATTE, "glass": glass(1.5), "lamp": lamp(3.0)}

    def counts(ball: str) -> np.ndarray:
        objects = [plane([0, 0, 0], [0, 0, 1], "matte"), sphere([0, 0, 0.3], 0.2, ball)]
        scene = scene_of(objects, materials, CAMERA)
        history = np.full((24, 24, 4), 100.0)
        return brought(scene, scene, history, context, Limits(50.0, 7.0, 3.0))[..., 3]

    of_matte, of_glass, of_lamp = map(counts, ("matte", "glass", "lamp"))
    assert of_matte[12, 12] == of_lamp[12, 12] == of_matte[0, 0] == 50
    assert of_glass[12, 12] == 7
    assert set(np.unique(of_matte)) == {3, 50}
    assert set(np.unique(of_glass)) == {3, 7, 50}
    assert set(np.unique(of_lamp)) == {0, 50}
    assert np.array_equal(of_lamp == 0, of_matte == 3)


def test_a_finer_view_shares_the_samples_of_a_coarse_one(context: Context) -> None:
    """Four fine pixels get a quarter each; a coarse pixel gets the samples of one fine pixel."""
    history = np.full((12, 16, 4), 8.0)
    fine = brought(wall(), wall(), history, context, size=(32, 24))
    np.testing.assert_allclose(fine[..., 3], 2.0, rtol=1e-5)
    coarse = brought(wall(), wall(), np.full((24, 32, 4), 8.0), context, size=(16, 12))
    np.testing.assert_allclose(coarse[..., 3], 8.0, rtol=1e-5)


def test_scenes_of_other_objects_share_no_numbers() -> None:
    balls = [sphere([x, 0, 0], 1.0, "matte") for x in (0, 3)]
    one, two = (scene_of(balls[:n], {"matte": MATTE}, CAMERA) for n in (1, 2))
    moved = scene_of([sphere([1, 0, 0], 2.0, "matte")], {"matte": MATTE}, CAMERA)
    assert shares_objects(one, moved)
    assert not shares_objects(one, two)
