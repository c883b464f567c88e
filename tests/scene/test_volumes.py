"""Which medium lies where: in volumes apart, in volumes within each other, and refusals."""

from typing import Any

import numpy as np
import pytest

from glrt.core.errors import SceneError
from glrt.plan.facts import SceneFacts
from glrt.scene.loading.scene_files import check_loaded
from glrt.scene.scene import Scene
from glrt.scene.scenefile.toml import parse_scene
from glrt.scene.schema.tables import scene_to_dict
from glrt.scene.volumes import MOST_VOLUMES, bounds_of, medium_around
from glrt.scene.warnings import cautions
from glrt.settings import Settings
from tests.support.builders import MATTE, box, glass, plane, quad, scene_of, sphere
from tests.support.meshes import icosphere, mesh

SETTINGS = Settings()
MEDIA = {name: {"scattering": [1.0] * 3} for name in ("air", "fog", "milk")}


def scene(*things: Any, camera: Any = None, **more: Any) -> Scene:
    materials = {"glass": glass(), "matte": MATTE}
    return scene_of(
        list(things),
        materials,
        camera,
        **{"media": MEDIA, "background": {"color": [1, 1, 1]}, **more},
    )


def body(thing: dict[str, Any], name: str | None) -> dict[str, Any]:
    return {**thing, **({"medium": name} if name else {})}


def ball(radius: float, name: str | None = "fog", material: str = "none", x: float = 0) -> Any:
    return body(sphere([x, 0, -5], radius, material), name)


def sides(found: Scene) -> list[tuple[str | None, str | None]]:
    return [(bounds.inside, bounds.outside) for bounds in bounds_of(found)]


def test_each_volume_lies_in_the_smallest_that_holds_it() -> None:
    found = scene(
        ball(0.1, None),
        ball(3, "fog"),
        ball(0.5, "milk", "glass"),
        sphere([0, 0, -5], 0.05, "matte"),
        ball(0.4, "fog", x=9),
        medium="air",
    )
    assert sides(found) == [
        *((None, "milk"), ("fog", "air"), ("milk", "fog"), ("fog", "air")),
    ]


def test_boxes_planes_and_meshes_hold_each_other_or_not() -> None:
    ground = body(plane([0, -2, 0], [0, 1, 0], "none"), "milk")
    deeper = body(plane([0, -4, 0], [0, 1, 0], "none"), "fog")
    block = body(box([-3, -1.5, -8], [3, 3, -2], "none"), "fog")
    found = scene(ground, deeper, block, mesh(icosphere(1), "glass", translate=[0, 0, -5]))
    assert sides(found) == [("milk", None), ("fog", "milk"), ("fog", None), (None, "fog")]


@pytest.mark.parametrize(
    ("place", "name"), [(0, "air"), (-2.5, "fog"), (-4.7, "milk"), (-5, None), (3, "air")]
)
def test_a_place_has_the_medium_of_the_innermost_volume(place: float, name: str | None) -> None:
    still = scene(ball(3), ball(0.5, "milk"), ball(0.1, None), medium="air")
    assert medium_around(still, np.array([0.0, 0.0, place])) == name
    eye = {"position": [0, 0, place], "look_at": [0, 1, place], "up": [0, 0, 1]}
    moved = scene(ball(3), ball(0.5, "milk"), ball(0.1, None), medium="air", camera=eye)
    found = SceneFacts(moved).media.around_camera
    assert (found.medium if found else None) == name


def test_without_media_nothing_is_asked_of_glass() -> None:
    crossing = scene(ball(1, None, "glass"), ball(1, None, "glass", x=1), media={})
    assert bounds_of(crossing) == ()
    check_loaded(crossing)


REFUSED = {
    "balls that cross": (
        (ball(1), ball(1, x=1)),
        "objects[0] (sphere) and objects[1] (sphere) cross",
    ),
    "glass across fog": (
        (ball(1), {**ball(1, None, "glass", x=1), "name": "lens"}),
        "('lens') cross",
    ),
    "boxes that share a face": (
        (
            body(box([-1, -1, -3], [1, 1, -2], "none"), "fog"),
            body(box([-1, -1, -4], [1, 1, -3], "none"), "milk"),
        ),
        "share a part of a face",
    ),
    "planes that cross": (
        (
            body(plane([0, -1, 0], [0, 1, 0], "none"), "fog"),
            body(plane([0, -1, 0], [1, 1, 0], "none"), "fog"),
        ),
        "cross",
    ),
    "a ball in the box around a mesh": (
        (body(mesh(icosphere(1), "none", translate=[0, 0, -5]), "fog"), ball(0.1, "milk")),
        "the first lies in the box around a mesh",
    ),
    "too many": (tuple(ball(0.1, x=x) for x in range(MOST_VOLUMES + 1)), "24 can be"),
    "a lens in two media": (
        (
            body(sphere([0, 0, -1], 1.001, "none"), "fog"),
            quad([0, 0, 0], [1, 0, 0], [0, 1, 0], "matte"),
        ),
        "camera: its lens lies across the surface of objects[0]",
    ),
}


@pytest.mark.parametrize("name", REFUSED)
def test_volumes_that_leave_a_place_open_are_refused_by_name(name: str) -> None:
    things, says = REFUSED[name]
    eye = {"defocus_angle": 5.0, "focus_distance": 5.0} if "lens" in says else None
    with pytest.raises(SceneError) as caught:
        check_loaded(scene(*things, camera=eye))
    assert says in str(caught.value)


def test_a_mesh_with_an_opening_bounds_no_medium() -> None:
    points, faces = icosphere(1)
    leaky = body(mesh((points, faces[:-1]), "none"), "fog")
    with pytest.raises(SceneError, match="encloses nothing and cannot bound a medium"):
        check_loaded(scene(leaky))


def test_hidden_objects_and_panes_bound_nothing() -> None:
    hidden = {**ball(1, x=1), "hidden": True}
    found = scene(ball(1), hidden)
    check_loaded(found)
    assert len(bounds_of(found)) == 1


def test_the_material_none_needs_no_table_and_is_written() -> None:
    found = scene(ball(1))
    assert found.materials["none"].type == "none"
    assert parse_scene(scene_to_dict(found), "again") == found


def test_a_material_of_that_name_keeps_its_meaning() -> None:
    found = scene_of([sphere([0, 0, -5], 1, "none")], {"none": MATTE})
    assert found.materials["none"].type == "lambertian"


def test_a_sky_that_fog_hides_for_ever_is_a_caution() -> None:
    said = cautions(scene(medium="fog"), SETTINGS)
    assert any("medium 'fog'" in text and "background" in text for text in said)
    assert not any("medium" in text for text in cautions(scene(ball(1)), SETTINGS))


def test_gas_that_glows_is_light_enough() -> None:
    glow = {"fog": {"emission": [1, 1, 1], "absorption": [1, 1, 1]}}
    lit = scene(ball(1), media=glow, background={"color": [0, 0, 0]})
    assert not any("no light" in text for text in cautions(lit, SETTINGS))
    dimmed = lit.model_copy(update={"lights": {"media.fog": 0.0}})
    assert any("no light" in text for text in cautions(dimmed, SETTINGS))
    scene_of([], {}, media=glow, medium="fog")  # there is something to see


def test_a_medium_changes_from_frame_to_frame() -> None:
    track = {"target": "media.fog.scattering", "times": [0, 1], "values": [[0, 0, 0], [2, 4, 6]]}
    moving = scene(ball(1), animation={"fps": 2, "tracks": [track]})
    assert moving.at_frame(1).media["fog"].scattering == (1.0, 2.0, 3.0)
    wrong = {**track, "target": "media.frog.scattering"}
    with pytest.raises(SceneError, match="unknown medium 'frog'"):
        scene(ball(1), animation={"fps": 2, "tracks": [wrong]})
