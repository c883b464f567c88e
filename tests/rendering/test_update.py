"""Edits of a running render: what each costs, and that none leaves anything behind."""

from collections.abc import Callable
from typing import Any

import moderngl
import pytest

from glrt.core.errors import RenderError, SceneError, UsageError
from glrt.gpu.context import Context
from glrt.gpu.glsl import Source
from glrt.phong import Phong
from glrt.rendering import device_scene, kernel_switch
from glrt.rendering.schedule import INTERACTIVE
from glrt.scene.scene import Scene
from glrt.settings import Cost, Settings, cost_of
from tests.support.builders import glass, lamp, plane, sphere
from tests.support.mixed_scene import EYE, MATERIALS, OBJECTS, everything
from tests.support.renders import rendered, rendering, same

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
    "effects": ("shadows",),
    "adaptive": "on",
    "phong": Phong(diffuse=0.5),
    "sampler": "sobol",
    "crop": (2, 3, 5, 7),
    "roulette": False,
    "caustics": "on",
    "particles": 1.0,
    "aimed": 0.2,
    "linked": 0.5,
    "probes": 3,
    "reuse": "both",
    "unbiased": False,
    "march_step": 0.5,
    "seed": 5,
    "exposure": 1.5,
    "tonemap": "agx",
    "aov": ("normal",),
    "denoise": "nlm",
}


@pytest.mark.slow_cases("caustics", "adaptive")
@pytest.mark.parametrize("setting", CHANGES)
def test_change_of_a_setting_costs_what_it_declares(context: Context, setting: str) -> None:
    order = list(Cost)
    declared = cost_of(setting)
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


@pytest.mark.slow
@pytest.mark.usefixtures("exact_kernels")
def test_first_glass_compiles_another_kernel(context: Context) -> None:
    plain = everything([*OBJECTS[:1], *OBJECTS[2:]])
    with rendering(plain, context) as renderer:
        assert renderer.update(everything()) is Cost.RECOMPILE
        assert renderer.update(plain) is Cost.RECOMPILE


def too_large() -> Scene:
    walls = [plane([0, 0, -50 - i], [0, 0, 1], "white") for i in range(1600)]
    return everything([*OBJECTS, *walls])


@pytest.mark.usefixtures("loop_limit")
def test_scene_beyond_the_loop_limit_is_refused(context: Context) -> None:
    with pytest.raises(SceneError, match="loop limit"), rendering(too_large(), context, bounces=50):
        pass


@pytest.mark.usefixtures("loop_limit")
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
    with rendering(everything(), context) as renderer:
        renderer.render(2)
        with pytest.raises((SceneError, UsageError)):
            renderer.update(scene, **change)
        assert renderer.samples == 2
        assert same(renderer.render(4).image(), rendered(everything(), context, 4))


def test_an_update_that_the_driver_refuses_changes_nothing(
    context: Context, fresh: Context, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A film whose layers are wider than any texture, and a kernel; in a frame that has begun."""

    def refuse(*_: object) -> None:
        raise RenderError("not this kernel")

    monkeypatch.setattr("glrt.rendering.renderer.INTERACTIVE", INTERACTIVE._replace(limit=1e-12))
    with rendering(everything(), fresh, layering="groups") as renderer:
        renderer.render(2)
        renderer.advance(0.0, 9)
        assert renderer.work > 2
        before = renderer.scene, renderer.settings, renderer.plan
        with pytest.raises(RenderError, match="along an edge"):
            renderer.update(RESTARTING["a turn"], width=16384, layering="lengths")
        with monkeypatch.context() as patch:
            patch.setattr(kernel_switch, "compiled", refuse)
            with pytest.raises(RenderError, match="not this kernel"):
                renderer.update(method="naive")
        assert (renderer.scene, renderer.settings, renderer.plan) == before
        assert renderer.samples == 2
        assert same(
            renderer.render(4).image(), rendered(everything(), context, 4, layering="groups")
        )


def test_a_refused_update_keeps_nothing_on_the_driver(
    context: Context, fresh: Context, monkeypatch: pytest.MonkeyPatch
) -> None:
    made: list[Any] = []

    def noting(make: Callable[..., Any]) -> Callable[..., Any]:
        def noted(*given: Any, **more: Any) -> Any:
            made.append(make(*given, **more))
            return made[-1]

        return noted

    with rendering(everything(), fresh) as renderer:
        for name in ("texture", "buffer", "compute_shader"):
            noted = staticmethod(noting(getattr(context.gl, name)))
            monkeypatch.setattr(moderngl.Context, name, noted)
        monkeypatch.setattr(Context, "finish", refusing)
        with pytest.raises(RenderError, match="device lost"):
            renderer.update(RESTARTING["a turn"], method="naive", width=20)
        monkeypatch.undo()
    kinds = {type(thing) for thing in made}
    assert kinds == {moderngl.Texture, moderngl.Buffer, moderngl.ComputeShader}
    assert all(isinstance(thing.mglo, moderngl.InvalidObject) for thing in made)


def refusing(_: Context) -> None:
    raise RenderError("device lost")


def test_settings_alone_pack_no_scene_and_moves_assemble_no_kernel(
    context: Context, monkeypatch: pytest.MonkeyPatch
) -> None:
    with rendering(everything(), context) as renderer:
        monkeypatch.setattr(Source, "whole", None)
        assert renderer.update(RESTARTING["a millionth of a step"]) is Cost.RESTART
        monkeypatch.setattr(device_scene, "pack_scene", None)
        assert renderer.update(seed=3, width=20) is Cost.RESTART
        monkeypatch.undo()
        moved = RESTARTING["a millionth of a step"]
        alone = rendered(moved, context, 3, seed=3, width=20)
        assert same(renderer.render(3).image(), alone)
