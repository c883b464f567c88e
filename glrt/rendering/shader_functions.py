"""Evaluate functions of the path tracer over arrays, with a scene that they see."""

from collections.abc import Mapping
from typing import Any, NamedTuple, TypedDict, Unpack

import moderngl
import numpy as np

from glrt.gpu.evaluate import Probe, path_files
from glrt.gpu.program import Resource
from glrt.gpu.struct_arrays import FILE, Arrays
from glrt.packing.image_texture import texture_of
from glrt.packing.kernel_structs import STRUCTS
from glrt.packing.particles import with_particles
from glrt.packing.scene_arrays import Dispatch, pack_frame, pack_scene
from glrt.packing.scene_tree import SceneTree, tree_of
from glrt.packing.shapes import NUMBERED
from glrt.packing.sky_table import sky_sampling, tree_texture
from glrt.packing.texel_texture import texture_of as texels_of
from glrt.packing.texture_maps import images_of, textures_of
from glrt.packing.voxel_texture import grids_of
from glrt.packing.voxel_texture import texture_of as voxels_of
from glrt.plan.facts import SceneFacts
from glrt.plan.features import everything
from glrt.plan.plan import Plan, prepare
from glrt.rendering.pipelines import ENVIRONMENT, SKY_TREE, TEXELS, VOXELS, scene_text, upload
from glrt.scene.instancing import Apart
from glrt.scene.scene import Scene
from glrt.settings import Settings, settings_for

Array = np.ndarray[Any, Any]


class World(NamedTuple):
    """The data that functions of the path tracer see."""

    scene: Scene | None = None  # None: an empty one
    settings: Settings | None = None  # of the frame; None: the scene's `[render]`
    constants: Mapping[str, bool | int] = {}  # in place of a feature that is compiled in
    apart: Apart = "repeated"  # meshes with trees of their own


EMPTY = World()


class Expression(TypedDict, total=False):
    """The text around an expression, as in `Probe`."""

    returns: str  # GLSL type of the result
    setup: str  # statements before it
    functions: str  # in front of main


def evaluate(
    gl: moderngl.Context,
    expression: str,
    inputs: Mapping[str, Any],
    world: World = EMPTY,
    **text: Unpack[Expression],
) -> Array:
    """Evaluate a GLSL expression of the path tracing functions over arrays (see `Probe`).

    Every feature is compiled in, and lamps are chosen as in the scene, unless the constants of
    the world say otherwise. The context must be current.
    """
    scene, settings, constants, apart = world
    settings = settings or (settings_for(scene.render) if scene else None)
    plan = prepare(scene, settings, apart=apart) if scene and settings else None
    tree = tree_of(plan.facts) if plan else None
    stack = {"TREE_STACK": tree.stack if tree else 0}
    prelude = {
        **everything(),
        **(_choice(plan.facts) if plan else {}),
        **stack,
        **constants,
    }
    arrays = with_particles(pack_scene(plan.facts, tree), plan) if plan else no_rows()
    texts = {FILE: scene_text(gl, arrays, "generic")}
    probe = Probe(expression, includes=path_files(), constants=prelude, texts=texts, **text)
    resources = resources_of(gl, plan, arrays, tree)
    try:
        return probe.run(gl, inputs, resources)
    finally:
        for resource in resources.values():
            resource.release()


def resources_of(
    gl: moderngl.Context, plan: Plan | None, arrays: Arrays, tree: SceneTree | None = None
) -> dict[str, Resource]:
    """The buffers and textures that the functions read; without a plan, a frame of zeros."""
    frame = bytes(STRUCTS["Frame"].itemsize)
    picture = plan.scene.sky if plan else None
    pixels = picture.pixels if picture else None
    sampling = sky_sampling(pixels) if pixels is not None else None
    if plan:
        counts = {struct: len(rows) for struct, rows in arrays.items()}
        density = sampling.density if sampling else 0.0
        frame = pack_frame(plan, counts, Dispatch(0, 1), tree, density)
    sky: dict[str, Resource] = {}
    if pixels is not None and sampling:
        sky = {ENVIRONMENT: texture_of(gl, pixels), SKY_TREE: tree_texture(gl, sampling.tree)}
    if plan and (images := images_of(textures_of(plan.facts))):
        sky[TEXELS] = texels_of(gl, images)
    if plan and plan.facts.media.grids:
        sky[VOXELS] = voxels_of(gl, grids_of(plan.facts))
    return {**upload(gl, arrays, "generic"), "FrameBlock": gl.buffer(frame), **sky}


def _choice(found: SceneFacts) -> dict[str, bool | int]:
    aimed = {"HAS_CONE": bool(found.cones), "HAS_ONE_SIDED": bool(found.one_sided)}
    aimed |= {"HAS_VERTEX_COLOR": found.is_colored, "HAS_CONDUCTOR": bool(found.lobes.conductors)}
    return {
        "CLUSTERS": found.clusters,
        "MANY_LIGHTS": found.has_many_lights,
        **aimed,
        "HAS_INSTANCE": bool(found.instances),
        "HAS_HIDDEN_BACK": bool(found.scene.hidden_backs),
        "INSTANCE_BITS": found.instance_bits,
        "HAS_TRANSMISSION": bool(found.lobes.transmitting),
        "HAS_MAP": bool(found.mapped),
        "HAS_HOLE": bool(found.lobes.passed),
        "HAS_MEDIA": bool(found.media.names),
        "HAS_GRID": bool(found.media.grids),
        "HAS_TRANSFER": bool(found.media.transfers),
        "BOUNDARIES": len(found.media.bounds),
        "HAS_RANKS": found.media.is_ranked,
        "HAS_COAT": bool(found.lobes.coated),
        "HAS_ANISOTROPY": bool(found.lobes.anisotropic),
        "HAS_IRIDESCENCE": bool(found.lobes.iridescent),
        "HAS_SHEEN": bool(found.lobes.sheened),
        "HAS_TRANSLUCENCY": bool(found.lobes.translucent),
        "HAS_DISPERSION": bool(found.lobes.dispersing),
        "HAS_ROUGH_GLASS": bool(found.rough_glasses),
        "HAS_ROUGH_PANE": bool(found.rough_panes),
        "HAS_ATTENUATION": bool(found.tinted),
        "HAS_NESTED": bool(found.nested),
        "NESTED_GLASSES": len(found.nested),
    }


def no_rows() -> dict[str, Array]:
    """The arrays of an empty scene."""
    trees = ("Node", "Slot", "Corner", "Triangle", "Instance", "Tint")
    images, lamps = (
        ("Axes", "Uv", "Tangent", "Map", "Maps"),
        ("Emitter", "Light", "Cluster", "Aim", "Target", "Sides"),
    )
    details = ("Material", "Conductor", "Glass", "Gloss", "Albedo", "Medium", "Boundary")
    others = (*trees, *images, *details, *lamps)
    return {struct: np.zeros(0, STRUCTS[struct]) for struct in (*NUMBERED, *others)}
