"""Recipes as JSON: nothing is lost, and what is not a recipe gets one paragraph."""

import json
from typing import Any

import pytest

from glrt.core.errors import SceneError
from glrt.image.recipe import Recipe, Traced, lasting
from glrt.scene.scenefile.toml import parse_scene
from glrt.settings import Settings, settings_for

SCENE = {
    "title": "Скляна куля — “glass”",
    "camera": {"position": [0.1, 1e-7, 2.9], "look_at": [0.0, 0.0, 0.0]},
    "background": {"bottom": [1.0, 1.0, 1.0], "top": [0.3, 0.5, 1.0 / 3.0]},
    "materials": {
        "glass": {"type": "dielectric"},
        "lamp": {"type": "light", "emission": [8, 8, 8]},
    },
    "lights": {"lamp": 0.1},
    "objects": [
        {"shape": "sphere", "center": [0.0, 0.0, 0.0], "radius": 0.35, "material": "glass"},
        {"shape": "plane", "point": [0, -1, 0], "normal": [0, 1, 0], "material": "lamp"},
    ],
}


@pytest.fixture
def recipe() -> Recipe:
    settings = Settings(
        width=7,
        height=5,
        bounces=3,
        seed=0xFFFFFFFF,
        crop=(1, 2, 3, 3),
        roulette=False,
        exposure=-0.1,
    )
    scene = parse_scene(SCENE, "test")
    return Recipe(scene=scene, settings=settings, samples=48, version="0.1.0", renderer="llvmpipe")


def test_a_recipe_survives_json_without_loss(recipe: Recipe) -> None:
    assert Recipe.from_json(recipe.to_json(), "x.png") == recipe


@pytest.fixture
def relit(recipe: Recipe) -> Recipe:
    traced = Traced(
        scene=recipe.scene, bounces=3, layering="groups", weights=[(0.1, 1.0, 1 / 3), (1, 0, 2)]
    )
    return recipe.model_copy(update={"traced": traced})


def test_what_was_traced_survives_json_without_loss(relit: Recipe) -> None:
    assert Recipe.from_json(relit.to_json(), "x.png") == relit


@pytest.mark.parametrize(
    ("key", "value", "named"),
    [
        ("traced.weights", [], "weights"),
        ("traced.weights", [[1, 1, 1]] * 3, "weights"),
        ("traced.weights", [[1, 1, -1]], "weights"),
        ("traced.weights", [[1, 1]], "weights"),
        ("traced.layering", "colours", "layering"),
        ("traced.bounces", 1001, "bounces"),
        ("traced.scene", None, "scene"),
        ("traced.scene.camera.fov", 0, "camera.fov"),
        ("traced", 3, "traced"),
    ],
)
def test_damaged_light_of_a_recipe_is_refused_with_the_key(
    relit: Recipe, key: str, value: Any, named: str
) -> None:
    with pytest.raises(SceneError, match=r"^x\.exr.*recipe") as caught:
        Recipe.from_json(damaged(relit, key, value), "x.exr")
    assert named in str(caught.value)
    assert "\n" not in str(caught.value)


def test_decisions_survive_json_and_without_their_key_there_are_none(recipe: Recipe) -> None:
    decided = recipe.model_copy(update={"decisions": {"method": "auto: counted work"}})
    assert Recipe.from_json(decided.to_json(), "x.png") == decided
    old = json.loads(decided.to_json())
    del old["decisions"]
    assert Recipe.from_json(json.dumps(old), "x.png") == recipe


def test_decisions_last_while_their_settings_do() -> None:
    chosen, told = Settings(bounces=3), {"method": "auto", "bounces": "auto"}
    assert lasting(told, chosen, settings_for(chosen, samples=7, exposure=1.0)) == told
    assert lasting(told, chosen, settings_for(chosen, bounces=4)) == {"method": "auto"}


def test_every_setting_is_written_out_so_that_new_defaults_change_no_old_recipe(
    recipe: Recipe,
) -> None:
    assert set(json.loads(recipe.to_json())["settings"]) == set(Settings.model_fields)


@pytest.mark.parametrize("caustics", ["off", "on"])
def test_a_recipe_from_before_there_were_links_has_none(recipe: Recipe, caustics: str) -> None:
    """Their default is not 0."""
    settings = {**json.loads(recipe.to_json())["settings"], "caustics": caustics}
    assert settings.pop("linked") > 0
    text = json.dumps({**json.loads(recipe.to_json()), "settings": settings})
    found = Recipe.from_json(text, "test").settings
    assert (found.caustics, found.linked) == (caustics, 0.0)


def test_the_json_is_one_line_of_ascii(recipe: Recipe) -> None:
    assert recipe.to_json().isascii()
    assert "\n" not in recipe.to_json()


def damaged(recipe: Recipe, key: str, value: Any) -> str:
    """The recipe's JSON with another value of a key such as `settings.width`."""
    table = json.loads(recipe.to_json())
    place = table
    *parents, last = key.split(".")
    for name in parents:
        place = place[name]
    place[last] = value
    return json.dumps(table)


@pytest.mark.parametrize(
    "text",
    ["", "hello", "{", "[1]", "null", "{}", '{"scene": 3}', "[" * 100_000, '{"scene": {}}', "\0"],
)
def test_what_is_no_recipe_is_refused_in_one_paragraph(text: str) -> None:
    with pytest.raises(SceneError) as caught:
        Recipe.from_json(text, "old/x.png")
    assert str(caught.value).startswith("old/x.png")
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("key", "value", "named"),
    [
        ("settings.width", 0, "settings.width"),
        ("settings.exposure", float("nan"), "settings.exposure"),
        ("settings.denoise", True, "settings.denoise"),
        ("samples", -1, "samples"),
        ("decisions", {"denoiser": "auto"}, "denoiser"),
        ("decisions", {"method": 3}, "decisions.method"),
        ("version", None, "version"),
        ("scene.camera.fov", 180.0, "camera.fov"),
        ("scene.objects", [{"shape": "torus"}], "torus"),
    ],
)
def test_a_damaged_recipe_is_refused_with_the_key(
    recipe: Recipe, key: str, value: Any, named: str
) -> None:
    with pytest.raises(SceneError, match=r"^x\.exr.*recipe") as caught:
        Recipe.from_json(damaged(recipe, key, value), "x.exr")
    assert named in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_recipe_cannot_be_changed(recipe: Recipe) -> None:
    with pytest.raises(ValueError, match="frozen"):
        recipe.samples = 1  # type: ignore[misc]
