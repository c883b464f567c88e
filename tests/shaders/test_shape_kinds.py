"""Every kind of shape is named wherever shaders and tests distinguish kinds of shapes."""

import pytest

from glrt.accel.shape_tree import Family
from glrt.core.resources import folder
from glrt.packing.kernel_structs import CONSTANTS
from glrt.packing.scene_tree import FAMILIES, MOST_CODES, check_kinds
from glrt.packing.shapes import PACKERS, PLACES, check_packers
from glrt.scene.shapes.kinds import KINDS
from tests.accel.test_shapes_by_tree import CROWD
from tests.support.every_feature import still_life
from tests.support.shape_kinds import FILES, order_of_surfaces, unnamed

SHADERS = folder("shaders_glsl")
IN_LEAVES = [struct.lower() for struct in FAMILIES]


def test_the_search_the_tree_and_surfaces_name_every_kind() -> None:
    assert unnamed(list(KINDS), IN_LEAVES, SHADERS) == {}


def test_a_kind_without_code_is_missed_everywhere() -> None:
    more = [*KINDS, "torus"]
    assert unnamed(more, [*IN_LEAVES, "torus"], SHADERS) == {name: {"torus"} for name in FILES}


def test_surfaces_are_asked_for_in_the_order_of_the_numbering() -> None:
    assert order_of_surfaces(SHADERS) == list(KINDS)


def test_scenes_that_ways_are_compared_on_hold_every_kind() -> None:
    """Else equal bits of the new kind by loop, tree, and each pipeline are not tested."""
    assert {it.shape for it in CROWD.objects} == {*KINDS} - {"mesh"}
    assert {it.shape for it in still_life().objects} == {*KINDS} - {"mesh"}


@pytest.mark.parametrize(
    ("families", "kinds", "message"),
    [
        ({}, ["ring"], r"kinds without leaves: \['ring'\]"),
        ({"Ring": Family(CONSTANTS["BOX"], ())}, [], f"number {CONSTANTS['BOX']} of Box"),
        ({"Ring": Family(CONSTANTS["TRIANGLES"], ())}, [], "number 7 of TRIANGLES"),
        ({"Ring": Family(MOST_CODES, ())}, [], "number 16, 0 to 15 exist"),
    ],
)
def test_a_kind_needs_leaves_of_a_number_of_their_own(
    families: dict[str, Family], kinds: list[str], message: str
) -> None:
    check_kinds(FAMILIES, KINDS)
    with pytest.raises(TypeError, match=message):
        check_kinds({**FAMILIES, **families}, [*KINDS, *kinds])


def test_a_kind_needs_a_packer_in_the_order_of_the_kinds() -> None:
    kinds = list(KINDS.values())
    with pytest.raises(TypeError, match="without a packer: Mesh"):
        check_packers(kinds[:-1], kinds)
    with pytest.raises(TypeError, match="another order"):
        check_packers(kinds[::-1], kinds)
    check_packers(PACKERS, kinds)


def test_a_kind_needs_a_field_of_its_place(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delitem(PLACES, "Sphere")
    with pytest.raises(TypeError, match="without a place: Sphere; add them to PLACES"):
        check_packers(PACKERS, list(KINDS.values()))
