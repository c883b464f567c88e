"""A renderer for what a picture's recipe tells."""

from dataclasses import replace

from glrt.blocks import Tier
from glrt.context import Choice, Context, Pipeline
from glrt.recipe import Recipe
from glrt.renderer import Renderer
from glrt.scene import Scene
from glrt.settings import Cost, Settings, settings_for


def open_renderer(
    scene: Scene,
    settings: Settings,
    recipe: Recipe | None,
    context: Context | Choice = "auto",
    tier: Tier = "generic",
    pipeline: Pipeline = "auto",
) -> Renderer:
    """A renderer of a scene, which came from a picture if there is a recipe.

    A picture that was relit is a weighted sum over what was traced. The same is traced again, so
    that the same bits come out, unless light or bounces have been changed since.
    """
    light = recipe.traced if recipe else None
    if not (recipe and light and _is_shown(recipe, scene, settings)):
        return Renderer(scene, settings, context, tier, pipeline)
    before = settings_for(settings, bounces=light.bounces)
    renderer = Renderer(light.scene, before, context, tier, pipeline, light.layering)
    cost = renderer.update(scene, **dict(settings))
    if cost in (None, Cost.FREE, Cost.RELIGHT):
        renderer.plan = replace(renderer.plan, weights=light.weights)
    return renderer


def _is_shown(recipe: Recipe, scene: Scene, settings: Settings) -> bool:
    return (scene, settings.bounces) == (recipe.scene, recipe.settings.bounces)
