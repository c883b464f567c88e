"""Phong's model with constants for all surfaces, against its formula in float64."""

import math
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from glrt.gpu.context import Context
from glrt.image.image import Image
from glrt.image.sources import load
from glrt.phong import Phong
from glrt.plan.facts import SceneFacts
from glrt.plan.features import needs_of
from glrt.plan.methods import CLASSIC
from glrt.plan.plan import prepare
from glrt.rendering.renderer import Renderer
from glrt.scene.lights.background import Background
from glrt.scene.scene import Scene, with_lights
from glrt.settings import TERMS, Cost, Method, settings_for
from tests.support.builders import glass, lamp, quad, scene_of, sphere
from tests.support.images import same_bits
from tests.support.renders import METHODS, rendered

Array = NDArray[np.float64]

PLACES = {
    "red": (-3.3, 0, 0),
    "brass": (-1.1, 0, 0),
    "paint": (1.1, 0, 0),
    "glass": (3.3, 0, 0),
    "label": (0, 2.2, 0),
}
MATERIALS: dict[str, dict[str, Any]] = {
    "red": {"type": "lambertian", "color": [0.8, 0.3, 0.1]},
    "brass": {"type": "metal", "color": [0.9, 0.7, 0.3], "roughness": 0.5},
    "paint": {"type": "principled", "color": [0.2, 0.4, 0.6], "roughness": 0.5},
    "glass": glass(),
    "label": {"type": "principled", "color": [0, 0, 0], "specular": 0.0},
    "lamp": lamp(40.0),
}
BALL, PANEL = np.array([-7.0, 6.0, 3.0]), np.array([-5.0, -5.0, 4.0])
EYE = np.array([0.0, 0.5, 12.0])
GIVEN = Phong(ambient=0.1, diffuse=0.7, specular=0.5, exponent=32)


def balls(eye: Any = EYE, ball: Any = BALL, **camera: Any) -> Scene:
    """A ball of each material, a lamp that is a ball and one that is a panel."""
    things = [sphere(place, 1.0, name) for name, place in PLACES.items()]
    panel = quad(PANEL - [0.5, 0.5, 0], [1, 0, 0], [0, 1, 0], "lamp")
    view = {"position": list(eye), "look_at": [0, 0.5, 0], "fov": 42, **camera}
    return scene_of([*things, sphere(ball, 0.5, "lamp"), panel], MATERIALS, view)


def seen(scene: Scene, context: Context, phong: Phong, **options: Any) -> Image:
    """One sample a pixel."""
    ways = {"method": "blinn", "width": 48, "height": 32, **options}
    return rendered(scene, context, 1, phong=phong, **ways)


def unit(rows: Array) -> Array:
    directions: Array = rows / np.linalg.norm(rows, axis=-1, keepdims=True)
    return directions


def towards_lamps(at: Array) -> list[tuple[Array, Array]]:
    """Directions to the centre of each lamp, (n, 3), and its irradiance there, (n, 1)."""
    found = []
    for center in (BALL, PANEL):
        distance = np.linalg.norm(center - at, axis=-1, keepdims=True)
        wi = (center - at) / distance
        across = math.pi * 0.5**2 if center is BALL else np.abs(wi[:, 2:])
        found.append((wi, 40.0 * across / distance**2))
    return found


def formula(phong: Phong, at: Array, normal: Array, color: Array, method: str = "blinn") -> Array:
    """The thesis's Appendix A at points with these normals and colours, (n, 3) each."""
    view = unit(EYE - at)
    whole = (phong.ambient or 0.0) * color
    for wi, irradiance in towards_lamps(at):
        cosine = (normal * wi).sum(axis=-1, keepdims=True)
        mirrored = 2 * (normal * view).sum(axis=-1, keepdims=True) * normal - view
        half, along = (normal, unit(wi + view)), (mirrored, wi)
        near = np.prod(half if method == "blinn" else along, axis=0).sum(axis=-1, keepdims=True)
        highlight = (phong.specular or 0.0) * np.maximum(near, 0) ** (phong.exponent or 0)
        light = (phong.diffuse or 0.0) * color * cosine + highlight
        whole = whole + np.where(cosine > 0, irradiance / math.pi * light, 0.0)
    return whole


def surfaces(image: Image, names: tuple[str, ...]) -> tuple[Array, Array, Array, Array]:
    """Radiance, points, normals and colours where the balls of these names are seen, (n, 3)."""
    at = image.aovs["position"].value.astype(np.float64).reshape(-1, 3)
    radiance = image.radiance.astype(np.float64).reshape(-1, 3)
    centers, every = np.array([PLACES[name] for name in names]), np.zeros((0, 3))
    parts: list[tuple[Array, ...]] = [(every, every, every, every)]
    for name, center in zip(names, centers, strict=True):
        on = np.abs(np.linalg.norm(at - center, axis=-1) - 1) < 1e-4
        assert on.sum() > 20, name
        color = MATERIALS[name].get("color", [0, 0, 0])
        parts.append((radiance[on], at[on], unit(at[on] - center), np.tile(color, (on.sum(), 1))))
    radiance, at, normal, color = (np.concatenate(rows) for rows in zip(*parts, strict=True))
    return radiance, at, normal, color


@pytest.mark.parametrize(
    "phong",
    [
        GIVEN,
        Phong(ambient=0.0, diffuse=0.0, specular=2.0, exponent=7),
        Phong(ambient=3.0, diffuse=1.0, specular=0.0, exponent=0),
        Phong(ambient=0.5, diffuse=0.2, specular=1.0, exponent=0),
    ],
)
def test_each_pixel_is_the_formula(context: Context, phong: Phong) -> None:
    image = seen(balls(), context, phong, aov=("position",))
    radiance, at, normal, color = surfaces(image, ("red", "brass", "paint"))
    truth = formula(phong, at, normal, color)
    np.testing.assert_allclose(radiance, truth, rtol=2e-4, atol=1e-6)
    cosines = [(normal * wi).sum(axis=-1) for wi, _ in towards_lamps(at)]
    dark = np.max(cosines, axis=0) < -1e-4
    assert dark.any(), "some points are behind the terminator"
    np.testing.assert_allclose(radiance[dark], (phong.ambient or 0.0) * color[dark], rtol=1e-6)


@pytest.mark.slow
def test_each_pixel_is_the_formula_around_the_mirrored_direction(context: Context) -> None:
    image = seen(balls(), context, GIVEN, aov=("position",), method="phong")
    radiance, at, normal, color = surfaces(image, ("red", "brass", "paint"))
    truth = formula(GIVEN, at, normal, color, "phong")
    np.testing.assert_allclose(radiance, truth, rtol=2e-4, atol=1e-6)


def test_a_highlight_is_brightest_where_the_normal_is_halfway(context: Context) -> None:
    gloss = Phong(ambient=0.0, diffuse=0.0, specular=1.0, exponent=5000)
    scene = with_lights_of_ball(balls(look_at=list(PLACES["red"]), fov=12))
    image = seen(scene, context, gloss, aov=("position",))
    radiance, at, normal, _ = surfaces(image, ("red",))
    half = unit(unit(EYE - at) + unit(BALL - at))
    near = (normal * half).sum(axis=-1)
    assert near[np.argmax(radiance[:, 0])] > max(0.998, near.max() - 1e-6)


def with_lights_of_ball(scene: Scene) -> Scene:
    """The scene with its panel so far away that it lights nothing."""
    panel = scene.objects[-1].model_copy(update={"corner": (0.0, 0.0, 1e9)})
    return scene.model_copy(update={"objects": (*scene.objects[:-1], panel)})


def test_the_half_vector_form_is_symmetric_in_light_and_view(context: Context) -> None:
    """Eye and lamp change places, at one distance from a point of the ball."""
    point, gloss = (
        np.array([-3.3, 0.0, 1.0]),
        Phong(ambient=0.0, diffuse=0.0, specular=1.0, exponent=50),
    )
    one, other = (point + 5 * unit(np.array(way)) for way in ([0.4, 0.1, 1.0], [-0.3, 0.3, 1.0]))
    found = []
    for eye, ball in ((one, other), (other, one)):
        look = {"look_at": point.tolist(), "fov": 1e-3}
        scene = with_lights_of_ball(balls(eye, ball, **look))
        found.append(float(seen(scene, context, gloss).radiance.mean()))
    assert found[0] > 0.01
    assert found[0] == pytest.approx(found[1], rel=1e-4)


def test_glass_and_what_reflects_nothing_have_neither_color_nor_highlight(context: Context) -> None:
    bright = Phong(ambient=1.0, diffuse=1.0, specular=1.0, exponent=0)
    image = seen(balls(), context, bright, aov=("position",))
    assert (surfaces(image, ("glass", "label"))[0] == 0).all()


def test_a_constant_that_is_left_out_is_as_the_material_has_it(context: Context) -> None:
    """Ambient light alone adds to the model; matte surfaces alone are lit evenly."""
    scene = balls()
    aov: dict[str, Any] = {"aov": ("position",)}
    names = ("red", "brass", "paint")
    usual = surfaces(seen(scene, context, Phong(ambient=0.0), **aov), names)[0]
    more, at, normal, color = surfaces(seen(scene, context, Phong(ambient=0.25), **aov), names)
    np.testing.assert_allclose(more, usual + 0.25 * color, rtol=1e-5, atol=1e-7)
    gloss = Phong(ambient=0.0, specular=0.5, exponent=20)
    radiance, at, normal, color = surfaces(seen(scene, context, gloss, **aov), ("red", "brass"))
    own = gloss.model_copy(update={"diffuse": 1.0})
    matte = (color == MATERIALS["red"]["color"]).all(axis=-1)
    np.testing.assert_allclose(
        radiance[matte], formula(own, at, normal, color)[matte], rtol=2e-4, atol=1e-6
    )
    bare = formula(gloss, at, normal, color)[~matte]
    np.testing.assert_allclose(radiance[~matte], bare, rtol=2e-4, atol=1e-6)


@pytest.mark.slow
@pytest.mark.parametrize("method", ["phong", "blinn"])
def test_materials_as_they_are_give_the_bits_of_no_table(context: Context, method: Method) -> None:
    """Matte surfaces and metal: the kernel has the constants, and all of them are left out."""
    scene = load("metals")
    size: dict[str, Any] = {"width": 32, "height": 24, "method": method}
    dark = scene.model_copy(update={"background": scene.background.model_copy(update=BLACK)})
    usual = rendered(dark, context, 4, **size)
    table = rendered(dark, context, 4, phong=Phong(ambient=0.0), **size)
    assert usual.radiance.mean() > 0.01
    if method == "phong":  # without rough metal, the model of blinn is that of phong
        assert same_bits(usual.radiance, table.radiance)
    np.testing.assert_allclose(table.radiance, usual.radiance, rtol=1e-5, atol=1e-7)


BLACK = {"color": (0.0, 0.0, 0.0), "bottom": None, "horizon": None, "top": None}


@pytest.mark.slow
@pytest.mark.parametrize("phong", [GIVEN, Phong(diffuse=0.5), Phong(specular=0.5, exponent=9)])
@pytest.mark.parametrize("method", ["phong", "blinn"])
def test_terms_of_light_add_up(context: Context, method: Method, phong: Phong) -> None:
    """Ambient and diffuse light are terms of the base, highlights are glossy; all is direct."""
    sky = Background(bottom=(0.2, 0.5, 0.1), top=(1.0, 0.4, 3.0))
    scene = balls().model_copy(update={"background": sky})
    image = seen(scene, context, phong, method=method, aov=TERMS)
    value: dict[str, Array] = {
        name: aov.value.astype(np.float64) for name, aov in image.aovs.items()
    }
    assert not value["indirect"].any()
    for parts in (("direct",), ("diffuse", "glossy")):
        whole = sum((value[name] for name in parts), value["emission"])
        np.testing.assert_allclose(whole, image.radiance, rtol=3e-6, atol=1e-7)
    if phong is GIVEN:
        flat = seen(scene, context, Phong(**{**dict(GIVEN), "specular": 0.0}), method=method)
        matte = value["emission"] + value["diffuse"]
        np.testing.assert_allclose(matte, flat.radiance, rtol=1e-5, atol=1e-6)


# --- what it costs ---------------------------------------------------------------------------


def test_without_constants_the_kernel_lacks_them() -> None:
    facts = SceneFacts(balls())
    for method in (*METHODS, *CLASSIC):
        usual, empty, given = (
            needs_of(facts, settings_for(facts.scene.render, method=method, phong=phong))
            for phong in (None, Phong(), GIVEN)
        )
        assert usual == empty
        assert not usual.own_phong
        assert given.own_phong == (method in ("phong", "blinn"))
        assert (given == usual) == (method not in ("phong", "blinn"))


def test_another_value_restarts_and_the_first_one_compiles() -> None:
    scene = balls()
    plan = prepare(scene, settings_for(scene.render, method="blinn", phong=GIVEN), "groups")

    def cost(phong: Phong | None) -> Cost:
        settings = plan.settings.model_copy(update={"phong": phong})
        return plan.cost_of(scene, settings, "groups")

    assert cost(GIVEN) is Cost.FREE
    for key, value in (("ambient", 0.2), ("diffuse", None), ("specular", 0.1), ("exponent", 3)):
        assert cost(GIVEN.model_copy(update={key: value})) is Cost.RESTART
    assert cost(None) is Cost.RECOMPILE


def test_ambient_light_belongs_to_no_lamp() -> None:
    """Weights of groups would change it, so lamps are traced again; without it they are weighed."""
    scene = balls()
    dimmed = with_lights(scene, {"lamp": 0.5})
    for phong, cost in ((GIVEN, Cost.RESTART), (Phong(diffuse=0.5), Cost.RELIGHT)):
        settings = settings_for(scene.render, method="blinn", phong=phong)
        sky = scene.model_copy(update={"background": Background(color=(1, 1, 1))})
        before = prepare(sky, settings, "groups")
        after = dimmed.model_copy(update={"background": sky.background})
        assert before.cost_of(after, settings, "groups") is cost


@pytest.mark.slow
def test_constants_change_without_another_kernel(context: Context) -> None:
    scene = balls()
    settings = settings_for(scene.render, method="blinn", phong=GIVEN, width=8, height=8)
    renderer = Renderer(scene, settings, context)
    renderer.render(1)
    assert renderer.update(scene, phong=Phong(specular=0.1, exponent=3)) is Cost.RESTART
    found = renderer.render(1).image()
    renderer.release()
    assert found.recipe
    assert found.recipe.settings.phong == Phong(specular=0.1, exponent=3)
    fresh = Renderer(scene, found.recipe.settings, context)
    assert same_bits(fresh.render(1).image().radiance, found.radiance)
    fresh.release()
