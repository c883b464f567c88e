"""The shaders of a plan, assembled without a driver."""

from collections.abc import Sequence

from glrt.gpu.glsl import Source
from glrt.gpu.struct_arrays import FILE
from glrt.packing.particles import with_particles
from glrt.packing.scene_arrays import pack_scene
from glrt.packing.scene_tree import SceneTree
from glrt.plan.plan import Plan
from glrt.rendering.passes import RADIANCE, RenderPass
from glrt.rendering.pipelines import KernelOptions, Variant, sources, text_of, tier_for


def constants_of(plan: Plan, tree: SceneTree | None, variant: Variant) -> dict[str, bool | int]:
    """Return the constants in the prelude of a plan's kernels; `tree` is the BVH of its scene."""
    stack = {"TREE_STACK": tree.stack if tree else 0}
    return {**plan.needs.constants(), **plan.constants(), **stack, **variant.constants}


def shaders_of(
    plan: Plan,
    tree: SceneTree | None,
    options: KernelOptions,
    most_bytes: int,
    passes: Sequence[RenderPass] = (RADIANCE,),
) -> list[Source]:
    """Return the sources that a renderer of the plan compiles for these passes.

    `most_bytes` is the room of the driver's uniform blocks, as `uniform_bytes` returns it.
    """
    arrays = with_particles(pack_scene(plan.facts, tree), plan)
    text = text_of(arrays, tier_for(arrays, options.tier), most_bytes)
    texts = {FILE: text, **options.variant.texts}
    constants = constants_of(plan, tree, options.variant)
    each = (sources(options.pipeline, constants, texts, one) for one in passes)
    return [source for shaders in each for source in shaders]
