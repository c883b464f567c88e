"""Materials in the panel: metals by name, and principled surfaces."""

from typing import Any

from glrt.scene.materials.conductors import PRESETS
from glrt.scene.scene import Scene
from glrt.settings import Cost
from tests.support.builders import scene_of, sphere
from tests.window.gestures import move
from tests.window.hand import Hand, check

SKY = {"color": [0.8, 0.9, 1.0]}


def show(hand: Hand, material: dict[str, Any]) -> None:
    """A ball of a material, selected."""
    scene: Scene = scene_of([sphere([0, 0, -3], 1, "it")], {"it": material}, background=SKY)
    hand.there(lambda: hand.window.app.edit_scene("", lambda _: scene))
    hand.settle()
    hand.window.app.selected = 0
    hand.ctx.yield_(3)


def its(hand: Hand) -> Any:
    return hand.session.scene.materials["it"]


@check
def a_metal_of_a_colour_becomes_a_measured_one_and_back(hand: Hand) -> None:
    show(hand, {"type": "metal", "color": [0.9, 0.6, 0.3], "roughness": 0.2})
    before = hand.pixels()
    move(hand, "reflects##material it/preset", None)
    hand.settle()
    assert (its(hand).preset, its(hand).color) == ("gold", None)
    assert (hand.pixels() != before).any()
    move(hand, "preset##material it/copper", None)
    hand.settle()
    assert its(hand).preset == "copper"
    move(hand, "reflects##material it/ior", None)
    hand.settle()
    assert tuple(PRESETS["copper"]) == (its(hand).ior, its(hand).k)
    move(hand, "reflects##material it/color", None)
    hand.settle()
    assert its(hand).color == PRESETS["copper"].head_on
    assert not hand.session.problem


@check
def a_principled_surface_is_edited_live(hand: Hand) -> None:
    show(hand, {"type": "principled", "color": [0.5, 0.1, 0.1]})
    for name, value, most in (
        ("metallic", 1.0, Cost.RESTART),
        ("roughness", 0.1, Cost.RESTART),
        ("clearcoat", 1.0, Cost.RECOMPILE),
        ("clearcoat roughness", 0.0, Cost.RESTART),
        ("anisotropy", 0.5, Cost.RECOMPILE),
        ("anisotropy rotation", 90.0, Cost.RESTART),
        ("diffuse transmission", 0.5, Cost.RECOMPILE),
        ("iridescence", 1.0, Cost.RECOMPILE),
        ("iridescence ior", 1.8, Cost.RESTART),
        ("iridescence thickness", 250.0, Cost.RESTART),
        ("ior", 2.0, Cost.RESTART),
    ):
        before, hand.session.last_cost = hand.pixels(), None
        move(hand, f"{name}##material it", value)
        hand.settle()
        assert getattr(its(hand), name.replace(" ", "_")) == value
        assert hand.session.last_cost is most, name
        has_no_effect = name in ("ior", "diffuse transmission")  # on metal
        assert has_no_effect or (hand.pixels() != before).any()
    for label, value, wanted, cost in (
        ("sheen##material it/##X", 0.5, (0.5, 0, 0), Cost.RECOMPILE),
        ("sheen roughness##material it", 0.75, 0.75, Cost.RESTART),
    ):
        move(hand, label, value)
        hand.settle()
        assert getattr(its(hand), label.partition("#")[0].replace(" ", "_")) == wanted
        assert hand.session.last_cost is cost
    move(hand, "transmission##material it", 0.5)  # with a coat: refused, and said
    hand.settle()
    assert "a coat over transmission" in hand.session.problem
    assert its(hand).transmission == 0


@check
def glass_is_tinted_and_nests(hand: Hand) -> None:
    """A value that a file leaves open has no widget until it is asked for."""
    show(hand, {"type": "dielectric"})
    assert not hand.ctx.item_exists("attenuation distance##material it")
    move(hand, "tinted##material it", None)
    hand.settle()
    assert its(hand).attenuation_distance == 1.0
    move(hand, "attenuation distance##material it", 2.0)
    hand.settle()
    assert its(hand).attenuation_distance == 2.0
    move(hand, "dispersion##material it", 0.5)
    hand.settle()
    assert (its(hand).dispersion, hand.session.last_cost) == (0.5, Cost.RECOMPILE)
    move(hand, "dispersion##material it", 0.0)
    move(hand, "nests##material it", None)
    hand.settle()
    assert its(hand).priority == 0
    move(hand, "tinted##material it", None)
    hand.settle()
    assert (its(hand).attenuation_color, its(hand).attenuation_distance) == (None, None)
    assert not hand.session.problem


@check
def a_ready_made_material_replaces_all_values(hand: Hand) -> None:
    show(hand, {"type": "metal", "color": [0.9, 0.6, 0.3], "roughness": 0.2})
    move(hand, "ready-made##material it/copper", None)
    hand.settle()
    assert (its(hand).preset, its(hand).color, its(hand).roughness) == ("copper", None, 0)
    before = hand.pixels()
    move(hand, "ready-made##material it/rubber", None)
    hand.settle()
    assert (its(hand).type, its(hand).roughness) == ("principled", 0.75)
    assert (hand.pixels() != before).any()
    assert not hand.session.problem
