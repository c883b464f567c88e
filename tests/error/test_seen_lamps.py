"""The light of lamps that pixels see in part: closed forms, and the renderer's own samples."""

import math
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from bench.fooling_scenes import fooling_scene
from glrt.error import seen_lamps as module
from glrt.error.seen_lamps import Seen, seen_lamps
from glrt.gpu.context import Context
from glrt.scene.scene import Scene
from glrt.settings import Settings
from tests.support.renders import rendering

SIZE = 9  # pixels; the middle of the picture is that of a pixel
DISTANCE = 10.0
PIXEL = 2 * math.tan(math.radians(30) / 2) / SIZE  # a pixel's side at distance 1
EMISSION = 1000.0
SKY = 0.25
BALL = {"shape": "sphere", "center": [0, 0, 0], "radius": 0.1, "material": "lamp"}
BEFORE = {"shape": "sphere", "center": [0, 0, 2], "radius": 0.5}


def scene(*objects: dict[str, Any], lamp: dict[str, Any] | None = None, **camera: Any) -> Scene:
    """Lamps on the z axis under an even sky, seen from far."""
    return Scene.build(
        {"position": [0, 0, DISTANCE], "look_at": [0, 0, 0], "fov": 30.0, **camera},
        objects,
        materials={
            "lamp": {"type": "light", "emission": [EMISSION] * 3, **(lamp or {})},
            "matte": {"type": "lambertian", "color": [0.5] * 3},
            "glass": {"type": "dielectric", "ior": 1.5},
            "mirror": {"type": "metal", "color": [0.9] * 3},
        },
        background={"color": [SKY] * 3},
    )


def found(made: Scene, size: int = SIZE, **settings: Any) -> Seen:
    """The lamps found in a picture of the sky alone, where no pixel is sure."""
    wanted = Settings(width=size, height=size, **settings)
    picture = np.full((*wanted.size[::-1], 3), SKY, np.float32)
    return seen_lamps(made, wanted, picture, picture)


def share_of(seen: Seen) -> NDArray[np.float64]:
    """How much of each pixel is lamp: radiance = share EMISSION + (1 - share) SKY."""
    return np.asarray((seen.radiance[:, 0] - SKY) / (EMISSION - SKY))


def test_a_ball_smaller_than_a_pixel_covers_its_disk() -> None:
    seen = found(scene(BALL))
    sine = 0.1 / DISTANCE
    disk = math.pi * sine**2 / (1 - sine**2)
    assert (seen.rows.tolist(), seen.columns.tolist()) == ([SIZE // 2], [SIZE // 2])
    assert share_of(seen)[0] == pytest.approx(disk / PIXEL**2, rel=0.01)


def test_the_edge_of_a_quad_covers_what_it_is_drawn_to() -> None:
    """Its left edge is 0.3 of a pixel inside the pixel in the middle."""
    side = PIXEL * DISTANCE
    corner = [-0.2 * side, -0.5 * side, 0.0]
    quad: dict[str, Any] = {"shape": "quad", "corner": corner, "material": "lamp"}
    seen = found(scene({**quad, "edge_u": [0.7 * side, 0, 0], "edge_v": [0, side, 0]}))
    assert share_of(seen).max() == pytest.approx(0.7, abs=0.02)


@pytest.mark.parametrize("focus", [DISTANCE, 6.0])
def test_a_lens_spreads_a_lamp_and_loses_nothing_of_it(
    monkeypatch: pytest.MonkeyPatch, focus: float
) -> None:
    monkeypatch.setattr(module, "STEPS", module.MORE_STEPS)  # few rays meet what is blurred
    lens: dict[str, Any] = {"defocus_angle": 10.0, "focus_distance": focus}
    sharp, blurred = found(scene(BALL)), found(scene(BALL, **lens))
    assert share_of(blurred).sum() == pytest.approx(share_of(sharp).sum(), rel=0.04)
    assert len(blurred.rows) == 1 if focus == DISTANCE else len(blurred.rows) >= 5


def test_what_stands_before_a_lamp_hides_it() -> None:
    assert not len(found(scene(BALL, {**BEFORE, "material": "matte"})).rows)
    behind = {**BEFORE, "center": [0, 0, -2], "material": "matte"}
    assert share_of(found(scene(BALL, behind))) == pytest.approx(share_of(found(scene(BALL))))


@pytest.mark.parametrize(
    ("objects", "lamp"),
    [
        ((BALL, {**BEFORE, "material": "glass"}), {}),
        ((BALL, {**BEFORE, "center": [0.2, 0, -2], "material": "mirror"}), {}),
        ((BALL,), {"cone": {"axis": [0, 0, 1], "outer": 40}}),
        (({"shape": "disk", "center": [0, 0, 0], "normal": [0, 0, 1], "radius": 0.1,
           "material": "lamp", "emission_side": "front"},), {}),
        ((BALL,), {"emission": [0.0, 0.0, 0.0]}),
        (({**BALL, "center": [0, 0, DISTANCE]},), {}),
        (({**BALL, "hidden": True},), {}),
    ],
    ids=["glass", "mirror", "cone", "one side", "dark", "around the camera", "hidden"],
)  # fmt: skip
def test_what_is_not_known_is_left_out(
    objects: tuple[dict[str, Any], ...], lamp: dict[str, Any]
) -> None:
    assert not len(found(scene(*objects, lamp=lamp)).rows)


def test_where_the_picture_is_uneven_nothing_is_known() -> None:
    picture = np.full((SIZE, SIZE, 3), SKY, np.float32)
    picture[: SIZE // 2] = 100.0
    wanted = Settings(width=SIZE, height=SIZE)
    assert len(seen_lamps(scene(BALL), wanted, picture, picture).rows) == 1
    picture[SIZE // 2 : SIZE // 2 + 2, SIZE // 2 - 1 : SIZE // 2 + 1] = 100.0
    picture[SIZE // 2, SIZE // 2 + 1] = 100.0
    assert not len(seen_lamps(scene(BALL), wanted, picture, picture).rows)


def test_a_crop_is_a_part_of_the_picture() -> None:
    whole, part = found(scene(BALL)), found(scene(BALL), crop=(3, 2, 5, 6))
    assert (part.rows + 2).tolist() == whole.rows.tolist()
    assert (part.columns + 3).tolist() == whole.columns.tolist()
    assert part.radiance == pytest.approx(whole.radiance)


def test_too_many_shapes_are_not_looked_through(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "MOST_SHAPES", 0)
    assert not len(found(scene(BALL)).rows)
    monkeypatch.undo()
    monkeypatch.setattr(module, "MOST_PIXELS", 3)
    assert len(found(scene({**BALL, "radius": 1.5}), size=33).rows) <= 3


@pytest.mark.slow
@pytest.mark.parametrize("seed", [1, 6])
def test_rims_are_as_many_samples_see_them(context: Context, seed: int) -> None:
    """One pixel in 100,000 lies more than 5 standard errors off by chance."""
    made, _ = fooling_scene("rims of small suns", seed)
    size = {"width": 48, "height": 36, "sampler": "independent", "bounces": 0}
    with rendering(made, context, **size) as renderer:
        image = renderer.render(8192).image()
    seen = seen_lamps(made, Settings(width=48, height=36), image.radiance, image.stderr)
    assert len(seen.rows) >= 1
    apart = np.abs(image.radiance[seen.rows, seen.columns] - seen.radiance)
    error = image.stderr[seen.rows, seen.columns] + 0.02 * seen.radiance
    assert (apart < 5 * error).all()


@pytest.mark.parametrize(
    ("hits", "times", "is_known"),
    [
        (1.0, 100.0, True),  # a single bright sample: its chance is 1 in 100
        (1.0, 1e7, False),  # a pixel so bright is not explained by the known lamps
        (25.0, 1.5, True),  # 25 samples where 17 were expected: about 2 standard errors
        (81.0, 3.0, False),  # 81 where 27 were: 1 in 10^15
    ],
)
def test_a_pixel_that_is_too_bright_to_be_so_by_luck_has_other_light(
    hits: float, times: float, is_known: bool
) -> None:
    """The pixel of a small lamp is `times` as bright as that makes it, by so many samples."""
    made, wanted = scene(BALL), Settings(width=SIZE, height=SIZE)
    picture = np.full((SIZE, SIZE, 3), SKY, np.float32)
    noise = picture.copy()
    (told,) = seen_lamps(made, wanted, picture, noise).radiance
    middle = SIZE // 2, SIZE // 2
    picture[middle] = times * told
    noise[middle] = picture[middle] / math.sqrt(hits)
    assert (seen_lamps(made, wanted, picture, noise).rows.size == 1) is is_known
