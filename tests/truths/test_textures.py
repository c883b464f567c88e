"""Pictures of textured surfaces: the bits of plain ones, and closed forms."""

from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

from glrt.gpu.context import Context, open_context
from glrt.plan.facts import SceneFacts
from glrt.plan.features import needs_of
from glrt.scene.scene import Scene
from glrt.settings import Aov, settings_for
from tests.support.builders import MATTE, lamp, plane, quad, scene_of, sphere
from tests.support.images import same_bits
from tests.support.meshes import icosphere, mesh
from tests.support.renders import METHODS, assert_agree, assert_mean, rendered, same, whole
from tests.support.system_packages import needs_osmesa
from tests.support.textures import with_images

EYE = {"position": [0, 1, 4], "look_at": [0, 0, 0], "fov": 40}
BLACK = {"color": [0.0] * 3, "specular": 0.0}


def even(value: Any) -> dict[str, Any]:
    """A texture that has one value everywhere."""
    return {"checker": [value, value]}


def principled(**keys: Any) -> dict[str, Any]:
    return {"type": "principled", **keys}


PANE = {"thin": True, "roughness": 0.0}
PLAIN_AND_EVEN: dict[str, tuple[dict[str, Any], dict[str, Any]]] = {
    "matte": ({**MATTE, "color": [0.25, 0.5, 0.75]}, {**MATTE, "color": even([0.25, 0.5, 0.75])}),
    "metal": (
        {"type": "metal", "color": [0.5] * 3, "roughness": 0.5},
        {"type": "metal", "color": even(0.5), "roughness": 0.5},
    ),
    "a factor": (
        {**MATTE, "color": [0.125, 0.25, 0.5]},
        {**MATTE, "color": {**even([0.25, 0.5, 1.0]), "factor": 0.5}},
    ),
    "principled": (principled(color=[0.5] * 3), principled(color=even(0.5))),
    "metallic": (principled(metallic=0.5), principled(metallic=even(0.5))),
    "emission": (
        principled(**BLACK, emission=[2.0] * 3),
        principled(**BLACK, emission={**even(0.5), "factor": 4.0}),
    ),
    "alpha": (principled(alpha=0.5), principled(alpha=even(0.5))),
    "transmission": (
        principled(**PANE, transmission=0.25, metallic=0.5),
        principled(**PANE, transmission={**even(0.5), "factor": 0.5}, metallic=0.5),
    ),
    "what is cut": (
        principled(alpha=0.5, alpha_cutoff=0.75),
        principled(alpha=even(0.5), alpha_cutoff=0.75),
    ),
    "what is not cut": (principled(), principled(alpha=even(0.5), alpha_cutoff=0.5)),
}


def room(material: dict[str, Any], mesh_too: bool = True) -> Scene:
    points, faces = icosphere(2)
    ball = mesh((points, faces), "m", uv=points[:, :2], scale=0.6, translate=[1.2, 0, 0])
    things = [sphere([-1.2, 0, 0], 0.6, "m"), plane([0, -1, 0], [0, 1, 0], "floor")]
    things += [quad([-0.5, 0.8, -1], [1, 0, 0], [0, -1.5, 0], "m"), *([ball] if mesh_too else [])]
    lights = [sphere([0, 4, 1], 0.5, "lamp")]
    materials = {"m": material, "floor": MATTE, "lamp": lamp(4.0)}
    return scene_of([*things, *lights], materials, EYE, background={"color": [0.2] * 3})


@pytest.mark.slow_cases("matte-naive", "matte-nee", "alpha-naive", "alpha-nee")
@pytest.mark.slow_cases("principled-naive", "what is not cut-naive")
@pytest.mark.slow_cases(
    "metal-naive",
    "metal-nee",
    "metal-mis",
    "principled-nee",
    "principled-mis",
    "metallic-naive",
    "metallic-nee",
    "metallic-mis",
    "transmission-naive",
    "transmission-nee",
    "transmission-mis",
    "what is not cut-nee",
    "what is not cut-mis",
)
@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("name", [name for name in PLAIN_AND_EVEN if name != "emission"])
def test_an_even_texture_gives_the_bits_of_its_value(
    context: Context, method: str, name: str
) -> None:
    plain, textured = PLAIN_AND_EVEN[name]
    first = rendered(room(plain), context, 8, method=method)
    assert same(first, rendered(room(textured), context, 8, method=method))


def test_an_even_emission_is_found_by_scattering_alone(context: Context) -> None:
    """The picture has the bits of the method that finds all lamps by scattering."""
    plain, textured = PLAIN_AND_EVEN["emission"]
    things = [sphere([-1, 0, 0], 0.6, "m"), plane([0, -1, 0], [0, 1, 0], "floor")]
    scenes = [scene_of(things, {"m": one, "floor": MATTE}, EYE) for one in (plain, textured)]
    naive = rendered(scenes[0], context, 64, method="naive")
    assert same(naive, rendered(scenes[1], context, 64, method="mis"))
    assert not needs_of(SceneFacts(scenes[1]), settings_for(scenes[1].render)).sample_lights


@pytest.mark.slow
def test_roughness_has_steps_of_a_code(context: Context) -> None:
    """0.2 is step 51 of 255: its facets are those of the number, up to the table's rounding."""
    scenes = [
        room(principled(metallic=1.0, roughness=value), mesh_too=False)
        for value in (0.2, {**even(1.0), "factor": 0.2})
    ]
    first, second = (rendered(scene, context, 64, bounces=3).radiance for scene in scenes)
    assert_allclose(second, first, rtol=2e-3, atol=1e-4)


@pytest.mark.parametrize("roughness", [0.1, 0.5, 1.0])
def test_white_metal_of_textured_roughness_loses_and_gains_nothing(
    context: Context, roughness: float
) -> None:
    """Far into the table, and between its knots."""
    metal = principled(color=[1.0] * 3, metallic=1.0, roughness={**even(1.0), "factor": roughness})
    scene = scene_of([sphere([0, 0, -3], 1, "m")], {"m": metal}, background={"color": [1.0] * 3})
    image = rendered(scene, context, 2048, roulette=False)
    assert_mean(whole(image), 1.0, within=0.01, floor=1e-3)


def test_a_wall_shows_an_image_as_it_is(context: Context) -> None:
    """Four pixels, each a quarter of a wall that emits: upper left first."""
    image = np.ones((2, 2, 4))
    image[..., :3] = np.arange(12).reshape(2, 2, 3) / 16
    picture = {"image": "a.png", "filter": "nearest"}
    material = principled(**BLACK, emission=picture)
    wall = quad([-1, 1, -1], [2, 0, 0], [0, -2, 0], "m")
    scene = scene_of([wall], {"m": material}, {"fov": 90})
    shown = rendered(with_images(scene, {"a.png": image}), context, 4, width=4, height=4)
    expected = image[..., :3].repeat(2, axis=0).repeat(2, axis=1)
    assert np.array_equal(shown.radiance, expected.astype(np.float32))


@pytest.mark.slow
def test_a_board_in_an_even_light_is_its_colors(context: Context) -> None:
    """A convex thing in a white surrounding has the radiance of its albedo: no variance."""
    board = {"type": "lambertian", "color": {"checker": [0.25, 0.75], "scale": 1}}
    wall = quad([-1, 1, -1], [2, 0, 0], [0, -2, 0], "m")
    scene = scene_of([wall], {"m": board}, {"fov": 90}, background={"color": [1.0] * 3})
    image = rendered(scene, context, 4, width=4, height=4, roulette=False, method="naive")
    albedo = np.kron([[0.25, 0.75], [0.75, 0.25]], np.ones((2, 2)))
    assert np.array_equal(image.radiance[..., 0], albedo.astype(np.float32))


SUN = {"elevation": 90.0, "angle": 0.01, "irradiance": [np.pi] * 3}


@pytest.mark.slow
def test_a_bent_normal_is_lit_as_the_inclined_plane(context: Context) -> None:
    """A sun straight above gives albedo times the cosine, wherever the bend leads."""
    image = np.ones((1, 1, 4))
    image[..., :3] = (np.array([0.48, -0.36, 0.8]) + 1) / 2
    material = principled(color=[0.5] * 3, specular=0.0, normal={"image": "n.png"})
    floor = plane([0, -1, 0], [0, 1, 0], "m")
    eye = {"position": [0, 2, 0], "look_at": [0, 0, -1e-3], "fov": 20}
    scene = scene_of([floor], {"m": material}, eye, sun=SUN)
    shown = rendered(with_images(scene, {"n.png": image}), context, 4, bounces=1)
    assert_allclose(shown.radiance, 0.5 * 0.8, rtol=2e-3)


def sheets(count: int) -> list[dict[str, Any]]:
    heights = np.linspace(0.2, 1.2, count)
    return [quad([-50, y, -50], [100, 0, 0], [0, 0, 100], "m") for y in heights]


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize(
    ("count", "alpha"), [(1, 0.5), (3, 0.25), pytest.param(100, 0.02, marks=pytest.mark.slow)]
)
def test_layers_let_light_through_one_by_one(
    context: Context, method: str, count: int, alpha: float
) -> None:
    """(1 - alpha)^n, on the way of the light and on that of the eye; a hole is no bounce."""
    black = principled(**BLACK, alpha=alpha)
    below = [plane([0, 0, 0], [0, 1, 0], "lamp"), *sheets(count)]
    eye = {"position": [0, 3, 0], "look_at": [0, 0, -1e-3], "fov": 20}
    seen = scene_of(below, {"m": black, "lamp": lamp(1.0)}, eye)
    image = rendered(seen, context, 2048, method=method, bounces=0)
    assert_mean(whole(image), (1 - alpha) ** count, within=0.02)


@pytest.mark.parametrize("method", ["nee", "mis"])
@pytest.mark.parametrize(("count", "alpha"), [(1, 0.5), (2, 0.25)])
def test_rays_to_lights_pass_the_layers_too(
    context: Context, method: str, count: int, alpha: float
) -> None:
    """The sun through n black sheets, a floor below them, seen from below them."""
    black = principled(**BLACK, alpha=alpha)
    eye = {"position": [0, 0.15, 0], "look_at": [0, 0, -1e-3], "fov": 20}
    floor = plane([0, 0, 0], [0, 1, 0], "floor")
    materials = {"m": black, "floor": MATTE}
    scene = scene_of([floor, *sheets(count)], materials, eye, sun=SUN)
    image = rendered(scene, context, 2048, method=method, bounces=1)
    assert_mean(whole(image), 0.5 * (1 - alpha) ** count, within=0.02, floor=2e-4)


@pytest.mark.parametrize("method", ["nee", "mis"])
def test_rays_to_lights_pass_what_the_path_has_passed(context: Context, method: str) -> None:
    """A floor under a sheet, seen and lit through it: one hole says nothing of the other."""
    eye = {"position": [0, 3, 0], "look_at": [0, 0, -1e-3], "fov": 20}
    floor = plane([0, 0, 0], [0, 1, 0], "floor")
    materials = {"m": principled(**BLACK, alpha=0.5), "floor": MATTE}
    scene = scene_of([floor, *sheets(1)], materials, eye, sun=SUN)
    image = rendered(scene, context, 4096, method=method, bounces=1)
    assert_mean(whole(image), 0.5**3, within=0.02)


@pytest.mark.slow
def test_a_lamp_behind_a_hole_is_weighed_from_where_the_path_scattered(context: Context) -> None:
    """All methods agree on a floor near a lamp behind a sheet."""
    sheet = quad([-3, 0.4, -3], [6, 0, 0], [0, 0, 6], "m")
    light = quad([-1, 0.8, -1], [2, 0, 0], [0, 0, 2], "lamp")
    floor = plane([0, 0, 0], [0, 1, 0], "floor")
    eye = {"position": [0, 0.3, 0.5], "look_at": [0, 0, 0], "fov": 40}
    materials = {"m": principled(**BLACK, alpha=0.5), "floor": MATTE, "lamp": lamp(1.0)}
    scene = scene_of([sheet, light, floor], materials, eye)
    first, *others = (
        rendered(scene, context, 4096, method=name, bounces=1, seed=seed)
        for seed, name in enumerate(METHODS)
    )
    for other in others:
        assert_agree(first, other, within=0.02)


@pytest.mark.slow
def test_a_hole_shows_what_is_behind_in_aovs_too(context: Context) -> None:
    """Nothing is left of a sheet that is cut away everywhere."""
    gone = principled(alpha=even(0.25), alpha_cutoff=0.5)
    wall = quad([-3, 3, -2], [6, 0, 0], [0, -6, 0], "floor")
    sheet = quad([-3, 3, -1], [6, 0, 0], [0, -6, 0], "m")
    names: tuple[Aov, ...] = ("albedo", "depth", "object")
    materials = {"m": gone, "floor": MATTE}
    first = rendered(scene_of([wall, sheet], materials, {"fov": 60}), context, 16, aov=names)
    second = rendered(scene_of([wall], materials, {"fov": 60}), context, 16, aov=names)
    for name in names:
        assert_allclose(first.aovs[name].value, second.aovs[name].value, rtol=1e-6)


@pytest.mark.slow
def test_textures_have_the_same_bits_everywhere(context: Context) -> None:
    """This holds in both pipelines and tiers, with a tree or not, and by EGL and OSMesa."""
    if not context.is_software:
        pytest.skip("bits are promised on software drivers alone")
    board = {"checker": [0.25, 0.75], "scale": [3.0, 2.0]}
    numbers = {"roughness": board, "metallic": board, "alpha": board}
    scene = room(principled(color=board, **numbers))
    expected = rendered(scene, context, 4)
    assert same(rendered(scene, context, 4, tier="complete"), expected)
    assert same(rendered(scene, context, 4, pipeline="fragment"), expected)
    if context.route == "egl":
        needs_osmesa()
    other = open_context("osmesa" if context.route == "egl" else "egl")
    with other.gl:
        assert same_bits(rendered(scene, other, 4).radiance, expected.radiance)
    other.gl.release()
