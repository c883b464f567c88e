"""Pictures whose light was changed come out of their recipes to the bit."""

from pathlib import Path
from typing import Any

import pytest

from glrt.cli.request import open_renderer
from glrt.gpu.context import Context
from glrt.image.image import Image
from glrt.image.sources import load_recipe, recipe_of
from glrt.plan.plan import Weights
from glrt.rendering.renderer import Renderer
from glrt.scene.scene import with_lights
from glrt.settings import Cost, settings_for
from tests.support.images import same_bits
from tests.support.relit_room import layered, radiance, room, tinted


def rendered_again(picture: Path, context: Context, **options: Any) -> Image:
    """The image that `glrt render` makes from a picture."""
    scene, settings = load_recipe(picture)
    assert settings
    settings = settings_for(settings, **options)
    renderer = open_renderer(scene, settings, recipe_of(picture), context, tier="complete")
    try:
        return renderer.render().image()
    finally:
        renderer.release()


def saved(renderer: Renderer, folder: Path, weights: Weights | None = None) -> tuple[Image, Path]:
    image, file = renderer.image(weights), folder / "relit.exr"
    image.save(file)
    return image, file


@pytest.mark.parametrize("lights", [{"warm": 0.3}, {"warm": 0.0, "cold": 1.7}, {"cold": 0.0}])
def test_a_relit_picture_comes_out_of_its_recipe_to_the_bit(
    context: Context, tmp_path: Path, lights: dict[str, float]
) -> None:
    with layered(room(2, warm=0.7, cold=0.0), context) as renderer:
        renderer.render(12)
        relit = tinted(with_lights(renderer.scene, lights), "warm", (3.0, 0.7, 0.5))
        assert renderer.update(relit) is Cost.RELIGHT
        image, file = saved(renderer, tmp_path)
    again = rendered_again(file, context)
    assert same_bits(again.radiance, image.radiance)
    assert same_bits(again.stderr, image.stderr)
    assert again.recipe
    assert image.recipe
    assert (again.recipe.scene, again.recipe.traced) == (relit, image.recipe.traced)
    with layered(relit, context, "none") as fresh:
        assert not same_bits(radiance(fresh.render(12)), image.radiance), "other random numbers"


@pytest.mark.slow
def test_a_picture_of_fewer_bounces_comes_out_of_its_recipe_to_the_bit(
    context: Context, tmp_path: Path
) -> None:
    with layered(room(2, 0.5), context, "lengths") as renderer:
        renderer.render(6)
        assert renderer.update(bounces=2) is Cost.RELIGHT
        image, file = saved(renderer, tmp_path)
        again = rendered_again(file, context)
        assert same_bits(again.radiance, image.radiance)
        assert again.recipe
        assert again.recipe.settings.bounces == 2
        alone, file = saved(renderer, tmp_path, renderer.plan.alone(1))
    assert same_bits(rendered_again(file, context).radiance, alone.radiance)
    assert not same_bits(alone.radiance, image.radiance)


def test_what_is_asked_for_next_to_a_relit_recipe_is_heeded(
    context: Context, tmp_path: Path
) -> None:
    with layered(room(2), context) as renderer:
        renderer.render(4)
        renderer.update(room(2, warm=0.3))
        _, file = saved(renderer, tmp_path)
    larger = rendered_again(file, context, width=20, samples=6)
    assert larger.radiance.shape == (16, 20, 3)
    assert larger.samples == 6
    more = rendered_again(file, context, bounces=7)
    with layered(room(2, warm=0.3), context, "none", bounces=7) as fresh:
        assert same_bits(more.radiance, radiance(fresh.render(4)))


def test_a_picture_that_was_not_relit_reports_its_scene_once(context: Context) -> None:
    with layered(room(2), context) as renderer:
        renderer.render(2)
        recipe = renderer.image().recipe
        assert recipe
        assert recipe.traced is None
        renderer.update(room(2, warm=0.3))
        renderer.update(room(2))
        assert renderer.image().recipe == recipe
