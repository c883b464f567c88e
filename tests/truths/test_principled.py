"""Principled surfaces in whole pictures: closed forms, limits, and one mean of all methods."""

from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

from glrt.core.errors import SceneError
from glrt.gpu.context import Context
from glrt.plan.omissions import omissions
from glrt.plan.plan import prepare
from glrt.scene.scene import Scene
from glrt.settings import Settings
from tests.support.builders import MATTE, box, lamp, plane, quad, scene_of, sphere
from tests.support.meshes import icosphere, mesh
from tests.support.renders import METHODS, assert_agree, rendered

WHITE_SKY = {"color": [1.0, 1.0, 1.0]}
GRADIENT = {"bottom": [0.2, 0.1, 0.4], "top": [0.9, 1.0, 0.7]}
SHEET = [quad([0, 0, 0], [1, 0, 0], [0, 1, 0], "p")]
CLOSE = {"position": [0, 0, 3], "look_at": [0, 0, 0], "fov": 15}


def principled(**keys: Any) -> dict[str, Any]:
    return {"type": "principled", **keys}


def ball(background: dict[str, Any] = WHITE_SKY, **keys: Any) -> Scene:
    """A ball of radius 1 that fills the picture."""
    things, looks = [sphere([0, 0, 0], 1, "p")], {"p": principled(**keys)}
    return scene_of(things, looks, CLOSE, background=background)


LOOKS: list[dict[str, Any]] = [
    {"roughness": 0.0},
    {"roughness": 0.3},
    {"roughness": 1.0},
    {"roughness": 0.6, "metallic": 1.0},
    {"roughness": 0.5, "metallic": 0.5, "specular": 0.4},
]


@pytest.mark.parametrize("look", LOOKS, ids=str)
def test_white_surfaces_vanish_under_a_white_sky(context: Context, look: dict[str, Any]) -> None:
    image = rendered(ball(**look), context, 1024)
    assert image.radiance.mean() == pytest.approx(1, abs=3e-3)


@pytest.mark.parametrize("roughness", [0.0, 0.1, 0.5])
def test_a_coat_never_gains_and_costs_little(context: Context, roughness: float) -> None:
    coated = ball(roughness=0.5, clearcoat=1.0, clearcoat_roughness=roughness)
    assert 0.92 < rendered(coated, context, 1024).radiance.mean() < 1.0


@pytest.mark.parametrize("method", METHODS)
def test_a_smooth_metal_shows_the_sky_by_schlicks_reflectance(
    context: Context, method: str
) -> None:
    """A plane seen at 60 degrees to its normal: one path for all samples."""
    color = np.array([0.9, 0.5, 0.2])
    materials = {"p": principled(color=color.tolist(), metallic=1.0, roughness=0.0)}
    floor = plane([0, 0, 0], [0, 1, 0], "p")
    eye = {"position": [0, 1, 3**0.5], "look_at": [0, 0, 0], "fov": 0.01}
    scene = scene_of([floor], materials, eye, background=GRADIENT)
    image = rendered(scene, context, 16, method=method)
    bottom, top = (np.array(GRADIENT[key]) for key in ("bottom", "top"))
    sky = bottom + (top - bottom) * 0.5 * (0.5 + 1)
    expected = sky * (color + (1 - color) * 0.5**5)
    assert_allclose(image.radiance, np.broadcast_to(expected, image.radiance.shape), rtol=2e-4)


def test_a_rough_metal_is_that_of_the_type_metal(context: Context) -> None:
    """White, where Schlick's reflectance is 1 too, and what facets lose returns: half a percent."""
    metal = {"type": "metal", "color": [1, 1, 1], "roughness": 0.25}
    things = [plane([0, -1, 0], [0, 1, 0], "m"), sphere([0, 0, 0], 1, "p")]
    eye = {"position": [0, 0.5, 5], "look_at": [0, 0, 0]}
    ours, theirs = (
        rendered(scene_of(things, {"m": MATTE, "p": material}, eye, background=GRADIENT),
                 context, 1024).radiance.mean()
        for material in (principled(metallic=1.0, roughness=0.25), metal)
    )  # fmt: skip
    assert 1.001 < ours / theirs < 1.008


def room() -> Scene:
    """Balls of each sort between a floor and a lamp."""
    materials = {
        "m": MATTE,
        "lamp": lamp(4.0),
        "paint": principled(
            color=[0.6, 0.1, 0.1], metallic=0.5, clearcoat=1.0, clearcoat_roughness=0.0
        ),
        "plastic": principled(color=[0.1, 0.3, 0.7], roughness=0.3, iridescence=1.0),
        "gold": principled(color=[1.0, 0.8, 0.4], metallic=1.0, roughness=0.5, anisotropy=0.6),
        "wax": principled(color=[0.9, 0.8, 0.7], roughness=0.0, sheen=[0.5, 0.6, 0.7]),
    }
    objects = [plane([0, 0, 0], [0, 1, 0], "m"), quad([-1, 2.5, -1], [2, 0, 0], [0, 0, 2], "lamp")]
    for k, name in enumerate(("paint", "plastic", "gold", "wax")):
        objects.append(sphere([k - 1.5, 0.45, 0], 0.45, name))
    camera = {"position": [0, 1.4, 5], "look_at": [0, 0.6, 0], "fov": 40}
    return scene_of(objects, materials, camera, background={"color": [0.1] * 3})


@pytest.mark.slow
def test_methods_agree_on_principled_surfaces(context: Context) -> None:
    naive, nee, mis = (
        rendered(room(), context, samples, method=method, seed=seed, bounces=4)
        for seed, (method, samples) in enumerate(zip(METHODS, (8192, 2048, 2048), strict=True))
    )
    assert_agree(naive, mis, within=0.05)
    assert_agree(nee, mis, within=0.05)


@pytest.mark.slow
def test_methods_agree_under_sky_and_sun(context: Context) -> None:
    """The light of both is weighed against all lobes at once."""
    scene = sunny()
    naive, nee, mis = (
        rendered(scene, context, samples, method=method, seed=seed, bounces=3)
        for seed, (method, samples) in enumerate(zip(METHODS, (8192, 2048, 2048), strict=True))
    )
    assert_agree(naive, mis, within=0.05)
    assert_agree(nee, mis, within=0.05)


def sunny() -> Scene:
    """The same balls, under a clear sky and a wide sun."""
    lit = room()
    materials = {name: it for name, it in lit.materials.items() if name != "lamp"}
    return Scene.build(
        lit.camera,
        [it for it in lit.objects if it.material != "lamp"],
        materials=materials,
        background={"sky": {"scale": 2.0}},
        sun={"elevation": 50.0, "azimuth": 20.0, "angle": 25.0},
    )


@pytest.mark.slow
def test_all_ways_and_sizes_show_the_same_bits(context: Context) -> None:
    def picture(**way: Any) -> bytes:
        return rendered(room(), context, 4, **way).radiance.tobytes()

    assert len({picture(), picture(pipeline="fragment"), picture(tier="complete")}) == 1


@pytest.mark.slow
def test_colours_of_vertices_multiply_that_of_the_material(context: Context) -> None:
    points, faces = icosphere(1)
    pictures = []
    for own, vertex in (([0.5, 0.25, 1.0], 1.0), ([1.0, 1.0, 1.0], [0.5, 0.25, 1.0])):
        colors = np.broadcast_to(vertex, points.shape)
        thing = mesh((points, faces), "p", smooth=False, colors=colors)
        materials = {"p": principled(color=own, metallic=0.5)}
        scene = scene_of([thing], materials, CLOSE, background=WHITE_SKY)
        pictures.append(rendered(scene, context, 4).radiance)
    assert_allclose(pictures[0], pictures[1], rtol=1e-5)


def test_a_scene_asks_for_the_lobes_that_it_uses() -> None:
    coated, plain = (prepare(it, Settings()).needs for it in (ball(clearcoat=0.5), ball()))
    assert (coated.has_coat, plain.has_coat, "principled" in plain.materials) == (True, False, True)
    told = omissions(prepare(room(), Settings()).facts, Settings(method="whitted"))
    assert "principled surfaces reflect lamps alone" in told


@pytest.mark.parametrize(
    ("keys", "said"),
    [
        ({"metallic": 1.5}, "metallic"),
        ({"roughness": -0.1}, "roughness"),
        ({"ior": 0.9}, "ior"),
        ({"specular": 2}, "specular"),
        ({"specular_color": [1, 1]}, "specular_color"),
        ({"clearcoat": "full"}, "clearcoat"),
        ({"clearcoat_roughness": 2}, "clearcoat_roughness"),
        ({"sheen": 1}, "sheen"),
    ],
)
def test_what_cannot_be_is_refused(keys: dict[str, Any], said: str) -> None:
    with pytest.raises(SceneError, match=said):
        ball(**keys)


SHARES = [{"transmission": 1.0}, {"transmission": 0.4}, {"transmission": 0.7, "metallic": 0.5}]


@pytest.mark.parametrize("share", SHARES, ids=str)
@pytest.mark.parametrize("roughness", [0.0, 0.5])
def test_white_glass_in_part_vanishes_under_a_white_sky(
    context: Context, share: dict[str, float], roughness: float
) -> None:
    look: dict[str, Any] = {"roughness": roughness, **share}
    image = rendered(ball(**look), context, 1024, bounces=64)
    assert image.radiance.mean() == pytest.approx(1, abs=6e-3)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("roughness", [0.0, 0.4])
def test_white_transmission_is_glass(context: Context, method: str, roughness: float) -> None:
    glass = {"type": "dielectric", "roughness": roughness}
    things = [plane([0, -1, 0], [0, 1, 0], "m"), sphere([0, 0, 0], 1, "p")]
    eye = {"position": [0, 0.5, 5], "look_at": [0, 0, 0]}
    ours, theirs = (
        rendered(scene_of(things, {"m": MATTE, "p": material}, eye, background=GRADIENT),
                 context, 512, seed=seed, method=method)
        for seed, material in enumerate((principled(transmission=1.0, roughness=roughness), glass))
    )  # fmt: skip
    assert_agree(ours, theirs, within=0.05)


def test_light_takes_the_colour_at_each_crossing(context: Context) -> None:
    """A slab of index 1, through which the sky is seen straight; a pane is crossed once."""
    color = np.array([0.9, 0.6, 0.3])
    eye = {"position": [0, 0, 3], "look_at": [0, 0, 0], "fov": 5}
    sheet = quad([-2, -2, 0], [4, 0, 0], [0, 4, 0], "p")
    slab = box([-2, -2, -0.1], [2, 2, 0.1], "p")
    for thing, crossings, more in (
        (slab, 2, {}),
        (sheet, 1, {"thin": True}),
        (slab, 2, {"attenuation_color": [0.5] * 3, "attenuation_distance": 0.2}),
    ):
        clear = {"ior": 1.0, "roughness": 0.0, "transmission": 1.0, "color": color.tolist()}
        scene = scene_of([thing], {"p": principled(**clear, **more)}, eye, background=WHITE_SKY)
        seen = rendered(scene, context, 16).radiance.reshape(-1, 3).mean(axis=0)
        left = 0.5 if "attenuation_color" in more else 1.0
        assert_allclose(seen, left * color**crossings, rtol=2e-3)


def test_glass_in_part_is_a_mean_of_glass_and_the_rest(context: Context) -> None:
    """Pictures of the parts alone, by their shares."""
    color = [0.7, 0.4, 0.2]

    def picture(**keys: Any) -> Any:
        floor = plane([0, 0, 0], [0, 1, 0], "p")
        eye = {"position": [0, 1, 1], "look_at": [0, 0, 0], "fov": 5}
        scene = scene_of([floor], {"p": principled(color=color, **keys)}, eye, background=GRADIENT)
        return rendered(scene, context, 2048, bounces=2).radiance.mean(axis=(0, 1))

    look = {"roughness": 0.3}
    metal, glass, matte = (
        picture(metallic=1.0, **look),
        picture(transmission=1.0, **look),
        picture(**look),
    )
    mixed = picture(metallic=0.25, transmission=0.6, **look)
    assert_allclose(mixed, 0.25 * metal + 0.75 * (0.6 * glass + 0.4 * matte), rtol=0.01)


BLACK = {"color": [0.0, 0.0, 0.0], "specular": 0.0}


@pytest.mark.slow
@pytest.mark.parametrize("method", METHODS)
def test_holes_let_light_through(context: Context, method: str) -> None:
    """A black sheet, before a white sky, and between a lamp and the floor."""
    sheet = quad([-9, 1, -9], [18, 0, 0], [0, 0, 18], "p")
    scene = scene_of([sheet], {"p": principled(alpha=0.25, **BLACK)},
                     {"position": [0, 0, 0], "look_at": [0, 1, 0], "up": [0, 0, 1]},
                     background=WHITE_SKY)  # fmt: skip
    seen = rendered(scene, context, 1024, method=method).radiance.mean()
    assert seen == pytest.approx(0.75, abs=0.006)
    materials = {"m": MATTE, "lamp": lamp(4.0)}
    things = [plane([0, 0, 0], [0, 1, 0], "m"), quad([-1, 2, -1], [2, 0, 0], [0, 0, 2], "lamp")]
    eye = {"position": [0, 0.5, 1], "look_at": [0, 0, 0], "fov": 20}
    lit = rendered(scene_of(things, materials, eye), context, 512, method=method, bounces=3)
    holed = materials | {"p": principled(alpha=0.6, **BLACK)}
    shaded = rendered(scene_of([*things, sheet], holed, eye), context, 4096, method=method, seed=3,
                      bounces=3)  # fmt: skip
    assert shaded.radiance.mean() / lit.radiance.mean() == pytest.approx(0.4, rel=0.03)


def test_a_scene_asks_for_glass_where_some_is_glass() -> None:
    plan = prepare(ball(transmission=0.5, roughness=0.3), Settings())
    assert [plan.needs.has_transmission, plan.needs.has_rough_glass] == [True, True]
    assert "dielectric" in plan.needs.materials
    assert not prepare(ball(), Settings()).needs.has_transmission
    assert prepare(ball(alpha=0.5), Settings()).needs.has_hole
    assert "glass is black" in omissions(plan.facts, Settings(method="phong"))


@pytest.mark.parametrize(
    ("keys", "said"),
    [
        ({"transmission": 0.5, "clearcoat": 1.0}, "a coat over transmission"),
        ({"transmission": 0.5, "thin": True, "dispersion": 1.0}, "a thin pane has no dispersion"),
        ({"transmission": 1.0, "attenuation_distance": 1.0}, "go together"),
        ({"transmission": 2.0}, "transmission"),
        ({"alpha": 0.5, "emission": [1.0, 1.0, 1.0]}, "a lamp has no alpha"),
    ],
)
def test_glass_that_cannot_be_is_refused(keys: dict[str, Any], said: str) -> None:
    with pytest.raises(SceneError, match=said):
        ball(**keys)


def test_a_quad_that_is_glass_in_part_is_refused() -> None:
    with pytest.raises(SceneError, match="encloses nothing"):
        scene_of(SHEET, {"p": principled(transmission=0.5)}, background=WHITE_SKY)
