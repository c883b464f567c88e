"""The shaders of a plan are those of its renderer, though no driver was asked."""

from glrt.gpu.context import Context
from glrt.gpu.struct_arrays import uniform_bytes
from glrt.packing.scene_tree import tree_of
from glrt.rendering.passes import RADIANCE, SURFACES
from glrt.rendering.pipelines import KernelOptions
from glrt.rendering.plan_shaders import shaders_of
from glrt.rendering.renderer import Renderer
from glrt.settings import settings_for
from tests.support.mixed_scene import everything


def test_the_shaders_of_a_plan_are_those_that_its_renderer_compiles(context: Context) -> None:
    scene = everything()
    settings = settings_for(scene.render, width=16, height=16)
    renderer = Renderer(scene, settings, context, layering="groups")
    plan, options = renderer.plan, KernelOptions(renderer.pipeline, "generic")
    room, passes = uniform_bytes(context.gl), (RADIANCE, SURFACES)
    ahead = shaders_of(plan, tree_of(plan.facts), options, room, passes)
    shaders = [*renderer.shaders, *renderer.device_scene.shaders_of(SURFACES)]
    wanted = [shader.live.text for shader in shaders]
    renderer.release()
    assert [shader.live.text for shader in ahead] == wanted
