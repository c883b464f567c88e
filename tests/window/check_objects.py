"""Objects: selected, moved and edited."""

import math
from typing import Any

import numpy as np
import pytest
from imgui_bundle import imgui

from glrt.plan.explanation import explain
from glrt.scene.lights.cone import Cone
from glrt.scene.materials.base import Opaque
from glrt.scene.scene import Scene
from glrt.scene.shapes.base import Object
from glrt.scene.shapes.kinds import Shape
from glrt.settings import Cost
from glrt.view.controls import Control
from glrt.view.panels import materials, objects, plots
from glrt.view.panels.gizmo import is_held
from glrt.view.viewport.orbit import axes
from glrt.view.widgets import fields
from tests.support.builders import MATTE, lamp, plane, quad, scene_of, sphere
from tests.window.gestures import ball, click, double_click, place_of, reopen
from tests.window.hand import SMALL, Hand, check


@check
def a_click_selects_and_restarts_nothing(hand: Hand) -> None:
    number, shape = ball(hand)
    restarts = hand.session.restarts
    click(hand, shape.center)
    assert hand.window.app.selected == number
    assert hand.session.restarts == restarts
    hand.ctx.key_press(imgui.Key.f.value)
    hand.settle()
    assert hand.session.scene.camera.look_at == shape.center
    right, up, _ = axes(hand.session.scene.camera)
    click(hand, shape.center - 0.92 * shape.radius * (right + up))  # next to it, off the handles
    assert hand.window.app.selected != number


@check
def handles_turn_an_object_about_its_middle_in_one_step(hand: Hand) -> None:
    app, session = hand.window.app, hand.session
    objects = session.scene.objects
    number, lamp_ = next((n, it) for n, it in enumerate(objects) if it.material == "lamp")
    app.selected = number
    hand.ctx.yield_(3)
    hand.ctx.key_press(imgui.Key.r.value)
    hand.ctx.yield_(3)
    assert app.handles == "turn"
    before, steps = session.scene, session.history.steps
    x, y = place_of(hand, lamp_.middle)
    for radius in range(80, 20, -1):  # the outer ring turns in the plane of the picture
        hand.ctx.mouse_move_to_pos(on_ring((x, y), radius, 0.0))
        hand.ctx.yield_(2)
        if hand.there(lambda: is_held(app)):
            break
    hand.ctx.mouse_down(0)
    for angle in (0.1, 0.2, 0.3, 0.4):
        hand.ctx.mouse_move_to_pos(on_ring((x, y), radius, angle))
        hand.ctx.yield_(2)
    hand.ctx.mouse_up(0)
    hand.settle()
    after: Any = session.scene.objects[number]
    turned_by = np.degrees(np.arccos(cosine(after.edge_u, before.objects[number])))
    assert 10 < turned_by < 30, turned_by
    assert np.allclose(after.middle, lamp_.middle, atol=1e-4)
    assert session.history.steps == steps + 1
    hand.ctx.key_press(imgui.Key.r.value)
    hand.ctx.yield_(2)
    assert hand.window.app.handles == "move"
    app.selected = None


def on_ring(middle: tuple[float, float], radius: float, angle: float) -> tuple[float, float]:
    """A place on a ring about a point of the screen, away from the rings of the axes."""
    turn = math.pi / 4 + angle
    return middle[0] + radius * math.cos(turn), middle[1] + radius * math.sin(turn)


def cosine(edge: Any, other: Any) -> float:
    """The cosine between an edge and the first one of a quad."""
    a, b = np.array(edge), np.array(other.edge_u)
    return float(a @ b / np.linalg.norm(a) / np.linalg.norm(b))


@check
def a_double_click_sets_the_pivot(hand: Hand) -> None:
    number, shape = ball(hand)
    hand.session.paused = True
    double_click(hand, shape.center)
    assert abs(math.dist(hand.window.app.pivot, shape.center) / shape.radius - 1) < 0.02
    assert hand.session.scene.objects[number] == shape


@check
def the_gizmo_moves_what_is_selected_without_compiling(hand: Hand) -> None:
    number, shape = ball(hand)
    hand.window.app.selected = number
    hand.ctx.yield_(2)
    restarts, camera = hand.session.restarts, hand.session.scene.camera
    x, y = place_of(hand, shape.center)
    hand.ctx.mouse_move_to_pos((x, y))
    hand.ctx.yield_(4)
    assert hand.there(lambda: is_held(hand.window.app))
    hand.ctx.mouse_down(0)
    hand.ctx.mouse_move_to_pos((x + 20, y))
    hand.ctx.mouse_move_to_pos((x + 40, y))
    hand.ctx.mouse_up(0)
    hand.settle()
    moved = hand.session.scene.objects[number]
    step = np.subtract(moved.center, shape.center)  # type: ignore[union-attr]
    assert np.dot(step, axes(camera)[0]) > 0.05
    assert hand.session.scene.camera == camera
    assert hand.session.restarts > restarts
    assert hand.session.last_cost is Cost.RESTART
    hand.ctx.item_click("//Picture/###undo")
    hand.settle()
    assert hand.session.scene.objects[number] == shape
    hand.window.app.selected = None


@check
def an_object_is_edited_in_the_panel(hand: Hand) -> None:
    number, shape = ball(hand)
    hand.window.app.selected = number
    hand.ctx.yield_(3)
    hand.ctx.set_ref("Controls")
    before = hand.pixels()
    hand.ctx.item_input_value(f"radius##shape {number}", 0.2)
    hand.settle()
    assert hand.session.scene.objects[number].radius == 0.2  # type: ignore[union-attr]
    hand.ctx.item_input_value(f"color##material {shape.material}/##X", 0.1)
    hand.settle()
    material: Any = hand.session.scene.materials[shape.material]
    assert material.color[0] == 0.1
    assert (hand.pixels() != before).any()
    hand.window.app.selected = None


@check
def an_object_is_chosen_in_a_list_of_thousands_and_a_frame_does_not_go_through_them(
    hand: Hand,
) -> None:
    app, ctx, named = hand.window.app, hand.ctx, objects._name
    panel: Any = objects
    figures: Any = plots
    crowd = [sphere([0.01 * n - 20, 0, -40], 0.1, "matte") for n in range(3000)]
    crowd[2] = sphere([0, 0, -30], 0.1, "lamp")  # what is asked of a lamp is asked once, too
    materials_of = {"matte": MATTE, "lamp": lamp(1.0)}
    scene = scene_of(crowd, materials_of, background={"color": [1, 1, 1]})
    hand.there(lambda: hand.session.edit(scene))
    hand.settle()
    ctx.set_ref("Controls")
    ctx.combo_click("object/$$3/2: sphere of lamp")
    assert app.selected == 2
    asked: list[int] = []

    def count(index: int, shape: Shape) -> str:
        asked.append(index)
        return named(index, shape)

    def fail(*_: object) -> Any:
        raise AssertionError("asked again for the same scene")

    patch = pytest.MonkeyPatch()
    try:
        panel._name, figures.explain = count, fail
        ctx.yield_(3)
        finishes: list[object] = []
        finish = Scene.finish

        def finished(scene: Scene, thing: Object) -> Any:
            finishes.append(thing)
            return finish(scene, thing)

        patch.setattr(Scene, "finish", finished)
        ctx.yield_(10)
        assert len(finishes) < 50, "of the selected object alone"
        assert set(asked) == {2}
        ctx.item_click("object")
        ctx.yield_(3)
        assert len(set(asked)) < 100
        ctx.popup_close_all()
    finally:
        patch.undo()
        panel._name, figures.explain = named, explain
    app.selected = None


@check
def what_edits_of_an_object_cost_stands_next_to_them(hand: Hand) -> None:
    number, _ = ball(hand)
    costs: dict[str, Cost] = {}
    marks: list[Cost] = []
    inner = fields.edited

    def seen(control: Control, value: Any, name: str = "") -> Any:
        costs[control.label] = control.cost
        return inner(control, value, name)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(materials, "edited", seen)
        patch.setattr(objects, "edited", seen)
        patch.setattr(objects, "tag", marks.append)
        hand.window.app.selected = number
        hand.turn_to("Scene")
    words = dict.fromkeys(("material", "ready-made", "type"), Cost.RECOMPILE)
    assert costs == {**words, "handles": Cost.RESTART}
    assert set(marks) == {Cost.RECOMPILE}  # of new objects
    hand.ctx.set_ref("Controls")
    hand.ctx.combo_click("material/red")
    hand.settle()
    assert hand.session.scene.objects[number].material == "red"
    assert hand.session.last_cost in (Cost.RESTART, Cost.RECOMPILE)
    hand.window.app.selected = None


@check
def a_texture_is_turned(hand: Hand) -> None:
    board = {**MATTE, "color": {"checker": [1.0, 0.0], "scale": 3.0}}
    shapes = [
        quad([-2, -2, -3], [4, 0, 0], [0, 4, 0], "board"),
        quad([-2, 2, -3], [4, 0, 0], [0, 0, 3], "lamp"),
    ]
    hand.there(
        lambda: hand.session.edit(scene_of(shapes, {"board": board, "lamp": lamp(4.0)}), **SMALL)
    )
    hand.settle()
    session, ctx = hand.session, hand.ctx
    hand.window.app.selected = 0
    ctx.yield_(3)
    ctx.set_ref("Controls")
    before, plain = hand.pixels(), session.scene
    ctx.item_input_value("rotation##color of board", 45.0)
    hand.settle()
    material = session.scene.materials["board"]
    assert isinstance(material, Opaque)
    assert material.textures["color"].rotation == 45
    assert session.last_cost == Cost.RESTART
    assert (hand.pixels() != before).mean() > 0.05
    hand.there(session.undo)
    assert session.scene == plain
    hand.window.app.selected = None


@check
def a_lamp_becomes_a_spot_of_one_side_and_a_hidden_object_goes(hand: Hand) -> None:
    shapes = [
        plane([0, -1, 0], [0, 1, 0], "white"),
        quad([-1, 0, -4], [2, 0, 0], [0, 2, 0], "lamp"),
    ]
    materials = {"white": MATTE, "lamp": lamp(2.0)}
    hand.there(lambda: hand.session.edit(scene_of(shapes, materials), **SMALL))
    hand.settle()
    session, ctx = hand.session, hand.ctx
    hand.window.app.selected = 1
    ctx.yield_(3)
    ctx.set_ref("Controls")
    before = hand.pixels()
    ctx.combo_click("emission side##shape 1/front")
    hand.settle()
    assert session.scene.objects[1].is_one_sided
    ctx.item_click("cone##lamp")
    hand.settle()
    material = session.scene.materials["lamp"]
    assert isinstance(material, Opaque)
    assert material.cone == Cone(axis=(0, -1, 0))
    assert (hand.pixels() != before).mean() > 0.05
    ctx.item_input_value("inner##cone lamp", 60.0)
    hand.settle()
    pushed = session.scene.materials["lamp"]
    assert isinstance(pushed, Opaque)
    assert pushed.cone == Cone(axis=(0, -1, 0), inner=60, outer=60)
    assert not session.problem
    before = hand.pixels()
    ctx.item_click("hidden##shape 1")
    hand.settle()
    assert session.scene.visible == session.scene.objects[:1]
    assert (hand.pixels() != before).mean() > 0.05
    for _ in range(4):
        hand.there(session.undo)
        hand.settle()
    assert session.scene == scene_of(shapes, materials, render=session.scene.render.model_dump())
    hand.window.app.selected = None
    reopen(hand)
