"""Edits of a running render: what each costs, and that none leaves anything behind."""

from typing import Any

import pytest

from glrt.context import Context
from glrt.errors import SceneError, UsageError
from glrt.scene import Scene
from glrt.settings import Cost, Settings
from tests.builders import glass, lamp, quad, sphere
from tests.mixture import EYE, MATERIALS, OBJECTS, everything
from tests.renders import rendered, rendering, same

RESTARTING: dict[str, Scene] = {
    "a millionth of a step": everything(camera={**EYE, "position": [0.100001, 0.2, 3.0]}),
    "a turn": everything(camera={**EYE, "look_at": [0.01, 0, 0]}),
    "another up": everything(camera={**EYE, "up": [0.01, 1, 0]}),
    "another angle of view": everything(camera={**EYE, "fov": 44.9}),
    "another aperture": everything(camera={**EYE, "defocus_angle": 2.5}),
    "another focus": everything(camera={**EYE, "focus_distance": 2.0}),
    "another colour": everything(
        materials={**MATERIALS, "white": {"type": "lambertian", "color": [0.8, 0.7, 0.61]}}
    ),
    "another emission": everything(materials={**MATERIALS, "lamp": lamp(6.5)}),
    "another index": everything(materials={**MATERIALS, "glass": glass(1.6)}),
    "another sky": everything(background={"color": [0.2, 0.2, 0.2]}),
    "a ball moved": everything(
        [*OBJECTS[:2], sphere([0.8, -0.5, 0.2], 0.5, "brass"), *OBJECTS[3:]]
    ),
    "a ball more": everything([*OBJECTS, sphere([0, -0.8, 1], 0.2, "red")]),
    "a ball less": everything([*OBJECTS[:1], *OBJECTS[2:]], materials=MATERIALS),
    "no lens": everything(camera={**EYE, "defocus_angle": 0.0}),
    "no sky": everything(background={}),
}


@pytest.mark.parametrize("edit", RESTARTING)
def test_edit_starts_again_and_leaves_nothing_behind(context: Context, edit: str) -> None:
    """A to B and back to A: each is as if rendered alone."""
    a, b = everything(), RESTARTING[edit]
    alone = [rendered(scene, context, 3, bounces=4) for scene in (a, b)]
    with rendering(a, context, bounces=4) as renderer:
        renderer.render(5)
        for scene, expected in ((b, alone[1]), (a, alone[0])):
            assert renderer.update(scene) in (Cost.RESTART, Cost.RECOMPILE)
            assert renderer.samples == 0
            assert same(renderer.render(3).image(), expected)
    assert not same(*alone)


CHANGES: dict[str, Any] = {
    "width": 19,
    "height": 11,
    "samples": 7,
    "bounces": 3,
    "method": "nee",
    "sampler": "sobol",
    "crop": (2, 3, 5, 7),
    "roulette": False,
    "seed": 5,
    "exposure": 1.5,
    "tonemap": "agx",
}


@pytest.mark.parametrize("setting", CHANGES)
def test_change_of_a_setting_costs_what_it_declares(context: Context, setting: str) -> None:
    order = list(Cost)
    extra: Any = Settings.model_fields[setting].json_schema_extra
    declared = Cost(extra["cost"])
    change = {setting: CHANGES[setting]}
    alone = rendered(everything(), context, 3)
    with rendering(everything(), context) as renderer:
        renderer.render(3)
        back = {setting: getattr(renderer.settings, setting)}
        cost = renderer.update(**change)
        assert cost is not None
        assert order.index(cost) <= order.index(declared)
        assert renderer.samples == (3 if declared is Cost.FREE else 0)
        if declared is not Cost.FREE:
            assert same(renderer.render(3).image(), rendered(everything(), context, 3, **change))
            renderer.update(**back)
            assert same(renderer.render(3).image(), alone)


def test_every_setting_with_a_choice_is_tried() -> None:
    assert CHANGES.keys() == Settings.model_fields.keys()


def test_same_state_sent_again_keeps_the_samples(context: Context) -> None:
    with rendering(everything(), context, seed=3) as renderer:
        renderer.render(4)
        assert renderer.update() is None
        assert renderer.update(everything(), seed=3, width=16, bounces=10) is None
        assert renderer.samples == 4


@pytest.mark.parametrize(
    "edit", ["a millionth of a step", "another colour", "a ball moved", "another emission"]
)
def test_moving_things_compiles_nothing(context: Context, edit: str) -> None:
    with rendering(everything(), context) as renderer:
        assert renderer.update(RESTARTING[edit]) is Cost.RESTART


def test_first_glass_compiles_another_kernel(context: Context) -> None:
    plain = everything([*OBJECTS[:1], *OBJECTS[2:]])
    with rendering(plain, context) as renderer:
        assert renderer.update(everything()) is Cost.RECOMPILE
        assert renderer.update(plain) is Cost.RECOMPILE


def too_large() -> Scene:
    corners = [[i % 40 - 20, i // 40 - 20, -50] for i in range(1600)]
    tiles = [quad(corner, [1, 0, 0], [0, 1, 0], "white") for corner in corners]
    return everything([*OBJECTS, *tiles])


def test_scene_beyond_the_loop_limit_is_refused(context: Context) -> None:
    if not context.is_software:
        pytest.skip("this machine renders on hardware")
    with pytest.raises(SceneError, match="loop limit"), rendering(too_large(), context, bounces=50):
        pass


@pytest.mark.parametrize(
    ("scene", "change"),
    [
        (too_large(), {"bounces": 50}),
        (RESTARTING["a turn"], {"crop": (9, 9, 99, 99)}),
    ],
    ids=["scene", "setting"],
)
def test_refused_update_changes_nothing(
    context: Context, scene: Scene, change: dict[str, Any]
) -> None:
    if not context.is_software:
        pytest.skip("this machine renders on hardware")
    with rendering(everything(), context) as renderer:
        renderer.render(2)
        with pytest.raises((SceneError, UsageError)):
            renderer.update(scene, **change)
        assert renderer.samples == 2
        assert same(renderer.render(4).image(), rendered(everything(), context, 4))
