"""The kernel's arrays of a scene, by the name of their struct, and its frame block."""

import math
from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from glrt.accel.sphere_nodes import pack_nodes
from glrt.gpu.struct_arrays import COUNTED
from glrt.gpu.structs import record
from glrt.packing.kernel_structs import STRUCTS
from glrt.packing.lights import lamps_of, pack_aims, pack_clusters, pack_lights
from glrt.packing.material_details import pack_conductors, pack_facets
from glrt.packing.materials import pack_emitters, pack_materials
from glrt.packing.media import medium_row, pack_media
from glrt.packing.particles import particle_fields
from glrt.packing.phong import phong_fields
from glrt.packing.probes import probe_fields
from glrt.packing.scene_tree import SceneTree, frame_fields, pack_tree
from glrt.packing.shapes import NUMBERED, Placing, in_order, pack_shapes, unit
from glrt.packing.texture_maps import pack_coordinates, pack_maps
from glrt.packing.triangles import pack_tints
from glrt.plan.facts import SceneFacts
from glrt.plan.methods import depth_of
from glrt.plan.plan import Plan
from glrt.scene.camera import Camera
from glrt.scene.values import BLACK

Array = np.ndarray[Any, Any]


def pack_scene(
    facts: SceneFacts, tree: SceneTree | None, known: Array | None = None
) -> dict[str, Array]:
    """Return the kernel's arrays of a scene, by the name of their struct.

    `tree` is the BVH of the scene that `tree_of` builds. `known` holds the nodes of a scene with
    the same spheres: their BVH is then refitted, not built again.
    """
    shapes = in_order(facts.scene)
    eye = np.array(facts.scene.camera.position, np.float64)
    lamps = lamps_of(facts, shapes, tree)
    rows = {finish: row for row, finish in enumerate(facts.finishes)}
    lights = {number: row for row, number in enumerate(lamps.shapes)}
    arrays = pack_shapes(shapes, Placing(eye, facts.scene, rows, lights))
    spheres = arrays["Sphere"][: None if facts.has_sphere_tree else 0]
    return {
        **arrays,
        "Node": pack_nodes(spheres, STRUCTS["Node"], known),
        **pack_tree(tree, arrays),
        **({"Triangle": tree.lit_by(lights, len(shapes))} if tree else {}),
        "Tint": pack_tints(facts),
        **pack_coordinates(facts, shapes, eye),
        **pack_maps(facts),
        "Material": pack_materials(facts),
        "Conductor": pack_conductors(facts),
        **pack_facets(facts),
        **pack_media(facts),
        "Emitter": pack_emitters(facts),
        "Light": pack_lights(lamps, STRUCTS["Light"]),
        "Cluster": pack_clusters(lamps, eye, STRUCTS["Cluster"]),
        "Aim": pack_aims(lamps, eye, STRUCTS["Aim"]),
        "Target": np.zeros(0, STRUCTS["Target"]),  # with_particles fills them
        "Sides": np.zeros(0, STRUCTS["Sides"]),
    }


class Dispatch(NamedTuple):
    """Samples and tiles of one dispatch, for the frame block."""

    first_sample: int
    samples: int
    first_tile: int = 0
    tile_stride: int = 1  # see shaders_glsl/passes/tiles.glsl
    is_empty: bool = True  # whether the film holds no sample yet: then it is not read


def pack_camera(camera: Camera, aspect: float) -> dict[str, object]:
    """Return the fields of the struct Camera; `aspect` is width over height of the full frame."""
    forward = unit(np.subtract(camera.look_at, camera.position))
    right = unit(np.cross(forward, camera.up))
    tan_y = math.tan(math.radians(camera.fov) / 2)
    tan_lens = math.tan(math.radians(camera.defocus_angle) / 2)
    return {
        "right": right,
        "tan_x": tan_y * aspect,
        "up": np.cross(right, forward),
        "tan_y": tan_y,
        "forward": forward,
        "lens_radius": tan_lens * camera.resolved_focus_distance,
        "tan_lens": tan_lens,
    }


def screen_axes(camera: Camera, aspect: float) -> dict[str, tuple[float, ...]]:
    """Return the axes of the camera by the names that passes over a picture use, (3,) each.

    `right` and `up` are half the width and height of the full frame at distance 1, `forward` unit.
    """
    view: dict[str, Any] = pack_camera(camera, aspect)
    right, up = view["right"] * view["tan_x"], view["up"] * view["tan_y"]
    axes = {"right": right, "up": up, "forward": view["forward"]}
    return {name: tuple(axis.tolist()) for name, axis in axes.items()}


def pack_frame(
    plan: Plan,
    counts: Mapping[str, int],
    dispatch: Dispatch,
    tree: SceneTree | None,
    sky_density: float = 0.0,
) -> bytes:
    """Return the bytes of the uniform block of one dispatch.

    `counts` are the numbers of rows by struct. `tree` is the BVH of the scene. `sky_density` is the
    density of samples of the sky image, as sky_table.py computes it.
    """
    scene, settings, glass = plan.scene, plan.settings, plan.facts.camera_glass
    media = plan.facts.media
    bottom, *horizon, top = scene.background_colors
    frame = {
        "camera": pack_camera(scene.camera, settings.width / settings.height),
        "background_bottom": bottom,
        "bounces": depth_of(settings),
        "background_horizon": horizon[0] if horizon else BLACK,
        "background_top": top,
        "sun_direction": scene.sun.towards if scene.sun else (0.0, 1.0, 0.0),
        "sun_versine": scene.sun.versine if scene.sun else 0.0,
        "sun_radiance": scene.sun_radiance,
        **particle_fields(plan),
        **probe_fields(plan.grid, scene.camera),
        **phong_fields(settings.phong),
        "march_step": settings.march_step,
        "camera_absorption": glass.absorption,
        "camera_counts": media.camera_volumes if media.is_ranked else glass.counts,
        "sky_density": sky_density,
        "background_turn": (scene.background.rotation or 0.0) / 360 % 1.0,
        "seed": settings.seed,
        "size": (settings.width, settings.height),
        "origin": settings.crop[:2] if settings.crop else (0, 0),
        "first_sample": dispatch.first_sample,
        "sample_count": dispatch.samples,
        **{f"{struct.lower()}_count": counts[struct] for struct in (*NUMBERED, *COUNTED)},
        "first_tile": dispatch.first_tile,
        "tile_stride": dispatch.tile_stride,
        "is_empty": int(dispatch.is_empty),
        "camera_medium": medium_row(plan.facts, media.around_camera),
        "coincident_reach": _coincident_reach(plan.facts),
        **frame_fields(tree, np.array(scene.camera.position, np.float64)),
    }
    return record(STRUCTS["Frame"], frame).tobytes()


def _coincident_reach(facts: SceneFacts) -> float:
    """Return the largest coordinate of coinciding surfaces, relative to the camera; else 0."""
    shared, eye = facts.coincidence, np.array(facts.scene.camera.position)
    corners = np.array([shared.low, shared.high])
    return float(np.abs(corners - eye).max()) if shared.pairs else 0.0
