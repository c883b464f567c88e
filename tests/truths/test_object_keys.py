"""Light groups of objects, and hidden objects: the bits of a scene that says the same."""

from glrt.gpu.context import Context
from glrt.plan.facts import SceneFacts
from glrt.plan.features import needs_of
from glrt.scene.scene import with_lights
from glrt.settings import Cost, settings_for
from tests.support.builders import MATTE, lamp, plane, quad, scene_of, sphere
from tests.support.images import same_bits
from tests.support.renders import rendered, rendering, same

FLOOR = plane([0, 0, 0], [0, 1, 0], "floor")
ABOVE = {"position": [0, 3, 0], "look_at": [0, 0, 0], "up": [0, 0, 1], "fov": 60}
BALL = sphere([0.4, 2, 0.1], 0.3, "lamp")
QUAD = quad([0, 2, 0], [0.5, 0, 0], [0, 0.1, 0.5], "lamp")


def test_objects_of_one_material_have_groups_of_their_own(context: Context) -> None:
    lamps = [
        sphere([-1, 1, 0], 0.2, "lamp") | {"group": "left"},
        sphere([1, 1, 0], 0.2, "lamp") | {"group": "right"},
        sphere([0, 1, 1], 0.2, "lamp"),
    ]
    scene = scene_of(
        [FLOOR, *lamps], {"floor": MATTE, "lamp": lamp(2.0)}, ABOVE, lights={"left": 0.5}
    )
    assert scene.light_groups == {"left": 0.5, "right": 1.0, "lamp": 1.0, "background": 1.0}
    told = {"half": lamp(1.0), "lamp": lamp(2.0), "floor": MATTE}
    halved = [lamps[0] | {"material": "half"}, *lamps[1:]]
    plain = scene_of([FLOOR, *halved], told, ABOVE)
    assert same(rendered(scene, context, 16), rendered(plain, context, 16))


def test_groups_of_one_material_are_dimmed_apart_without_a_new_render(context: Context) -> None:
    """Seen directly: two balls of one lamp, half a picture each."""
    balls = [
        sphere([-1, 0, -3], 0.9, "lamp") | {"group": "left"},
        sphere([1, 0, -3], 0.9, "lamp") | {"group": "right"},
    ]
    scene = scene_of(balls, {"lamp": lamp(2.0)})
    with rendering(scene, context, bounces=0, layering="groups") as renderer:
        renderer.render(16)
        assert renderer.update(with_lights(scene, {"left": 0.25})) is Cost.RELIGHT
        found = renderer.image().radiance
    assert found[:, :8].max() == 0.5
    assert found[:, 8:].max() == 2.0


def test_another_colour_of_a_lamp_in_two_groups_is_weighed_in_both(context: Context) -> None:
    balls = [
        sphere([-1, 0, -3], 0.9, "lamp") | {"group": "left"},
        sphere([1, 0, -3], 0.9, "lamp") | {"group": "right"},
    ]
    scene, tinted = (
        scene_of(balls, {"lamp": lamp(2.0, emission=emission)})
        for emission in ([2.0, 2.0, 2.0], [1.0, 4.0, 0.0])
    )
    with rendering(scene, context, bounces=0, layering="groups") as renderer:
        renderer.render(16)
        assert renderer.update(tinted) is Cost.RELIGHT
        found = renderer.image().radiance
    assert found.max(axis=(0, 1)).tolist() == [1.0, 4.0, 0.0]


def test_a_surface_that_stops_to_emit_is_traced_again(context: Context) -> None:
    ways = ({"emission": [1.0] * 3, "group": "one"}, {"emission": [0.0] * 3, "group": "one"})
    first, second = (
        scene_of(
            [sphere([-1, 0, -3], 0.9, "a"), sphere([1, 0, -3], 0.9, "lamp")],
            {"a": {**MATTE, **way}, "lamp": lamp(2.0, group="one")},
        )
        for way in ways
    )
    with rendering(first, context, bounces=0, layering="groups") as renderer:
        renderer.render(16)
        assert renderer.update(second) in (Cost.RESTART, Cost.RECOMPILE)
        found = renderer.render(16).image().radiance
    assert same_bits(found, rendered(second, context, 16, bounces=0).radiance)


def test_a_hidden_object_is_not_there(context: Context) -> None:
    ball = sphere([0, 0.5, 0], 0.5, "glass")
    materials = {"floor": MATTE, "lamp": lamp(2.0), "glass": {"type": "dielectric", "ior": 1.5}}
    lamps = [QUAD, BALL | {"hidden": True}]
    objects = [FLOOR, ball | {"hidden": True}, *lamps]
    scene = scene_of(objects, materials, ABOVE)
    plain = scene_of([FLOOR, QUAD], materials, ABOVE)
    settings = settings_for(scene.render)
    assert needs_of(SceneFacts(scene), settings) == needs_of(SceneFacts(plain), settings)
    assert same(rendered(scene, context, 16), rendered(plain, context, 16))
    image = rendered(scene, context, 16, aov=("object",))
    assert set(image.aovs["object"].value.ravel().tolist()) == {1, 3}, (
        "numbers are those of the file"
    )
