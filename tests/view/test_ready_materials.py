"""Ready-made materials: what they are called, and what they replace."""

import pytest

from glrt.view.edits.ready_materials import READY, ready_name, with_ready
from tests.support.builders import MATTE, scene_of, sphere


@pytest.mark.parametrize("ready", READY)
def test_a_material_takes_all_values_of_a_ready_one_and_its_name(ready: str) -> None:
    red = {"type": "metal", "color": [1, 0, 0]}
    before = scene_of([sphere([0, 0, 0], 1, "it")], {"it": red, "other": MATTE})
    found = with_ready(before, "it", ready)
    assert found.materials["it"] == READY[ready]
    assert found.materials["other"] == before.materials["other"]
    assert ready_name(found.materials["it"]) == ready


def test_no_two_ready_materials_are_the_same() -> None:
    assert [ready_name(material) for material in READY.values()] == [*READY]


def test_a_material_with_other_values_has_no_ready_name() -> None:
    gold = READY["gold"]
    assert ready_name(gold.model_copy(update={"roughness": 0.1})) == ""


def test_fog_leaves_an_object_that_becomes_opaque() -> None:
    media = {"fog": {"scattering": [1, 1, 1], "absorption": [0, 0, 0]}}
    ball = {**sphere([0, 0, 0], 1, "it"), "medium": "fog"}
    before = scene_of([ball], {"it": {"type": "dielectric", "ior": 1.5}}, media=media)
    assert with_ready(before, "it", "diamond").objects[0].medium == "fog"
    assert with_ready(before, "it", "rubber").objects[0].medium is None
