"""Names are not traced: who renames something keeps all samples, and the recipe has the names."""

from typing import Any

import pytest

from glrt.gpu.context import Context
from glrt.scene.nameless import less_names
from glrt.scene.scene import Scene, with_lights
from glrt.settings import Cost
from glrt.view.controls import replaced
from glrt.view.edits.scene_edits import with_object, with_renamed_material
from tests.support.images import same_bits
from tests.support.relit_room import layered, radiance, room


def renamed(scene: Scene) -> Scene:
    """Every name is another one; so are the names of light groups."""
    for name in [*scene.materials]:
        scene = with_renamed_material(scene, name, f"{name} by another name")
    for index, thing in enumerate(scene.objects):
        scene = with_object(scene, index, replaced(thing, name=f"thing {index}"))
    return replaced(scene, title="Another title")


@pytest.mark.parametrize("layering", ["none", "groups", "lengths"])
def test_other_names_lose_no_sample(context: Context, layering: Any) -> None:
    scene = room(2)
    other = renamed(scene)
    assert [*other.light_groups] != [*scene.light_groups]
    with layered(scene, context, layering) as renderer:
        renderer.render(8)
        before = radiance(renderer)
        assert renderer.update(other) is Cost.FREE
        assert renderer.samples == 8
        assert same_bits(radiance(renderer), before)
        recipe = renderer.image().recipe
        assert recipe
        assert recipe.scene == other
    with layered(other, context, layering) as fresh:
        assert same_bits(radiance(fresh.render(8)), before)


def test_light_is_weighed_on_under_other_names(context: Context) -> None:
    scene = room(2)
    with layered(scene, context) as renderer:
        renderer.render(8)
        renderer.update(with_lights(scene, {"warm": 0.5}))
        before = renderer.plan.weights
        other = renamed(renderer.scene)
        assert renderer.update(other) is Cost.FREE
        assert renderer.plan.weights == before
        group = next(name for name, value in other.light_groups.items() if value == 0.5)
        assert renderer.update(with_lights(other, {group: 2.0})) is Cost.RELIGHT
        assert renderer.samples == 8


def test_what_is_more_than_a_name_is_distinguished() -> None:
    scene = room(2)
    other = renamed(scene)
    assert len(set(map(id, less_names(scene, scene)))) == 1
    first, second = less_names(scene, other)
    assert first == second
    one = renamed(room(1))
    swapped = replaced(one, materials=dict(reversed(one.materials.items())))
    first, second = less_names(room(1), swapped)
    assert first != second  # the kernel numbers materials in their order
    lamps = [n for n, thing in enumerate(other.objects) if other.finish(thing).group]
    one_group = other
    for index in lamps:
        one_group = with_object(one_group, index, replaced(one_group.objects[index], group="all"))
    first, second = less_names(scene, replaced(one_group, lights={}))
    assert first != second  # two groups are not one
    hidden = with_object(other, 0, replaced(other.objects[0], hidden=True))
    first, second = less_names(scene, hidden)
    assert first != second
