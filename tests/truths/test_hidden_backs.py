"""Meshes with `backfaces = "hidden"`: rays pass triangles that they meet from behind."""

from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

from glrt.core.errors import SceneError, UsageError
from glrt.gpu.context import Context
from glrt.image.image import Image
from glrt.plan.combinations import check_render
from glrt.plan.facts import SceneFacts
from glrt.plan.features import needs_of
from glrt.rendering.renderer import Renderer
from glrt.scene.scene import Scene
from glrt.scene.shapes.mesh import Mesh
from glrt.settings import settings_for
from tests.support.builders import glass, lamp, plane, scene_of, sphere
from tests.support.meshes import Faces, icosphere, mesh, quads
from tests.support.renders import METHODS, assert_agree, rendered

MATERIALS: dict[str, dict[str, Any]] = {
    "white": {"type": "lambertian", "color": [0.8, 0.8, 0.8]},
    "lamp": lamp(4.0),
    "glass": glass(),
}
UNDER = {"position": [0, -0.2, 0], "look_at": [0, -1, 0], "up": [0, 0, 1], "fov": 40}
ABOVE = {"position": [0, 1, 0], "look_at": [0, 0, 0], "up": [0, 0, 1], "fov": 40}
BESIDE = {"position": [0, 1, 3], "look_at": [0, 1.99, 0], "fov": 20}
FLOOR = plane([0, -1, 0], [0, 1, 0], "white")
SMALL = {"width": 16, "height": 16, "bounces": 1}
HIDDEN: dict[str, Any] = {"backfaces": "hidden", "smooth": False}


def flat(height: float, half: float, faces_up: bool = True) -> Faces:
    """A level square about the y axis."""
    edges = [0, 0, 2 * half], [2 * half, 0, 0]
    return quads([[-half, height, -half], *(edges if faces_up else edges[::-1])])


def place(screen: Faces, camera: dict[str, Any], lamp_faces_up: bool = False, **keys: Any) -> Scene:
    """A screen between a floor and a lamp that shines downwards; both hide their backs."""
    shining = mesh(flat(2, 0.3, lamp_faces_up), "lamp", **HIDDEN)
    things = [FLOOR, mesh(screen, "white", **HIDDEN | keys), shining]
    return scene_of(things, MATERIALS, camera, background={"color": [0, 0, 0]})


def seen(scene: Scene, context: Context, **more: Any) -> Any:
    return rendered(scene, context, 16, **SMALL | more).radiance


UP, DOWN = flat(0, 2), flat(0, 2, faces_up=False)


def test_rays_of_all_kinds_pass_backs(context: Context) -> None:
    """Cases of one kernel."""
    away = seen(place(UP, UNDER, translate=[0, 9, 0]), context)
    assert away.min() > 0, "the lamp lights the floor"
    assert_allclose(seen(place(UP, UNDER), context), away, rtol=1e-5)  # rays to the lamp pass
    assert seen(place(DOWN, UNDER), context).max() == 0, "they meet its front"
    assert seen(place(UP, ABOVE), context).min() > 0, "the screen is lit"
    assert seen(place(DOWN, ABOVE), context).max() == 0, "the floor is seen, in the shadow"


def test_the_front_stays_the_front_of_mirrored_and_turned_meshes(context: Context) -> None:
    assert seen(place(DOWN, ABOVE, scale=[1, -1, 1]), context).min() > 0
    assert seen(place(UP, ABOVE, scale=[1, -1, 1]), context).max() == 0
    assert seen(place(UP, ABOVE, scale=[-1, 1, 1]), context).min() > 0
    assert seen(place(UP, ABOVE, rotate=[180, 0, 0]), context).max() == 0


def test_neighbours_that_face_apart_hide_their_own_backs(context: Context) -> None:
    points, faces = UP
    turned = faces.copy()
    turned[1] = turned[1][::-1]
    share = (seen(place((points, turned), ABOVE), context) > 0).all(axis=2).mean()
    assert 0.3 < share < 0.7


def test_a_lamp_with_hidden_backs_emits_from_its_front(context: Context) -> None:
    assert seen(place(UP, UNDER, lamp_faces_up=True), context).max() == 0
    assert seen(place(UP, BESIDE), context).max() >= 4, "seen from below"
    assert seen(place(UP, BESIDE, lamp_faces_up=True), context).max() < 4, "a ray passes it"


@pytest.mark.slow
@pytest.mark.parametrize("method", METHODS)
def test_all_methods_agree_about_hidden_backs(context: Context, method: str) -> None:
    scene = place(flat(0, 0.7), UNDER | {"fov": 100})
    small = {"width": 16, "height": 16, "bounces": 3}
    first = rendered(scene, context, 4096, seed=1, **small)
    assert_agree(first, rendered(scene, context, 4096, method=method, **small), 0.1)


@pytest.mark.slow
def test_a_closed_mesh_looks_the_same_without_its_backs(context: Context) -> None:
    """Also with a tree of its own, and mirrored there."""
    ball = icosphere(3)

    def picture(backs: str, apart: Any, **keys: Any) -> Image:
        things = [mesh(ball, "white", backfaces=backs, **keys), FLOOR, sphere([0, 3, 0], 1, "lamp")]
        scene = scene_of(things, MATERIALS, {"position": [0, 1, 5], "look_at": [0, 0, 0]})
        renderer = Renderer(scene, context=context, apart=apart, width=24, height=24)
        try:
            return renderer.render(64).image()
        finally:
            renderer.release()

    for keys in ({}, {"scale": [1, -1, 1]}):
        expected = picture("both", "repeated", **keys)
        for apart in ("repeated", "large"):
            assert_allclose(
                picture("hidden", apart, **keys).radiance, expected.radiance, rtol=1e-3, atol=1e-3
            )


def test_the_kernel_knows_hidden_backs_only_where_a_mesh_has_them() -> None:
    scene = place(UP, UNDER)
    plain = scene_of([FLOOR, mesh(UP, "white")], MATERIALS, UNDER, background={"color": [1, 1, 1]})
    assert needs_of(SceneFacts(scene), settings_for(scene.render)).has_hidden_back
    assert not needs_of(SceneFacts(plain), settings_for(plain.render)).has_hidden_back


def test_a_click_goes_through_backs() -> None:
    thing = scene_of([mesh(UP, "white", **HIDDEN)], MATERIALS, UNDER).meshes[0]
    down, up = np.array([0.0, -1, 0]), np.array([0.0, 1, 0])
    assert thing.distance(np.array([0.1, 3, 0.2]), down) == 3
    assert thing.distance(np.array([0.1, -3, 0.2]), up) == np.inf


def test_objects_in_one_place_cover_nothing_with_hidden_backs() -> None:
    for other in (mesh(DOWN, "white", **HIDDEN), mesh(UP, "white")):
        two = [mesh(UP, "white", **HIDDEN), other]
        assert len(scene_of(two, MATERIALS, UNDER).meshes) == 2
    assert len(scene_of([mesh(UP, "white")] * 2, MATERIALS, UNDER).meshes) == 1


def test_meshes_with_and_without_backs_share_no_tree() -> None:
    both = scene_of([mesh(UP, "white"), mesh(UP, "white", **HIDDEN)], MATERIALS, UNDER)
    forms = {it.form for it in both.objects if isinstance(it, Mesh)}
    assert len(forms) == 2


@pytest.mark.parametrize("keys", [{"material": "glass"}, {"material": "none"}, {"medium": "fog"}])
def test_hidden_backs_of_what_light_must_leave_are_refused(keys: dict[str, Any]) -> None:
    thing = mesh(icosphere(1), "white", **HIDDEN) | keys
    fog = {"fog": {"scattering": [1.0, 1.0, 1.0]}}
    with pytest.raises(
        SceneError, match=r"objects\[0\]\.backfaces.* hidden does not go with glass"
    ):
        scene_of([thing], MATERIALS, media=fog if "medium" in keys else {})


def test_particles_are_refused_with_hidden_backs() -> None:
    scene = place(UP, UNDER)
    settings = settings_for(scene.render, caustics="on")
    with pytest.raises(UsageError, match="some meshes hide their backs"):
        check_render(SceneFacts(scene), settings, "none", False, False)
