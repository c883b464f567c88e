"""The kernel contains what its scene needs and nothing else.

A read of a uniform `probe_X` is planted into the text of every feature X. A linked program lists
the uniforms that it still reads; so `probe_X` stands in the list exactly if X is compiled in.
"""

import shutil
from pathlib import Path
from typing import Any

import moderngl
import numpy as np
import pytest

from glrt.gpu import glsl
from glrt.gpu.glsl import Source
from glrt.gpu.program import Kernel
from glrt.methods.contents import MOST_NEAR, SPHERES_FROM, TREE_FROM
from glrt.methods.features import Needs, needs_of
from glrt.resources import folder
from glrt.settings import settings_for
from tests.support.builders import (
    EVERYTHING,
    MATTE,
    box,
    cylinder,
    disk,
    glass,
    lamp,
    plane,
    quad,
    scene_of,
    sphere,
)
from tests.support.kernel_text import written_for_everything
from tests.support.meshes import mesh

FLAGS = {name for name, value in EVERYTHING.items() if value is True}
# Of each feature: its file, an expression that it computes, and that expression with the probe.
PROBES = {
    "HAS_SPHERE": ("shapes/sphere.glsl", "sqrt(discriminant)", "sqrt(discriminant + {})"),
    "HAS_PLANE": ("shapes/plane.glsl", "dot(p - plane.point,", "dot(p - {} * plane.point,"),
    "HAS_QUAD": ("shapes/quad.glsl", "dot(quad.dual_u, p)", "dot({} * quad.dual_u, p)"),
    "HAS_DISK": ("shapes/disk.glsl", "dot(p, p)", "dot({} * p, p)"),
    "HAS_BOX": ("shapes/box.glsl", "- face.w)", "- {} * face.w)"),
    "HAS_CYLINDER": ("shapes/cylinder.glsl", "height * cylinder.axis", "{} * cylinder.axis"),
    "HAS_SPHERE_TREE": (
        "shapes/sphere_tree.glsl",
        "lesser(last.z, limit)",
        "lesser(last.z, {} * limit)",
    ),
    "HAS_TREE": ("shapes/tree.glsl", "int(slot.d.w & LINK)", "int({} * float(slot.d.w & LINK))"),
    "HAS_MESH": ("shapes/mesh.glsl", "shares.y * b.z", "{} * shares.y * b.z"),
    "HAS_SMOOTH": ("shapes/mesh.glsl", "shares.y * normalized(", "{} * shares.y * normalized("),
    "HAS_VERTEX_COLOR": ("shapes/mesh.glsl", "first + shares.y", "first + {} * shares.y"),
    "HAS_MIRROR": ("bsdfs/metal.glsl", "if (mirror) return", "if (mirror && {} > 0.0) return"),
    "HAS_ROUGH_METAL": ("bsdfs/metal.glsl", "_normal(alpha, vertex.wo", "_normal({}, vertex.wo"),
    "HAS_CONDUCTOR": ("bsdfs/conductor.glsl", "= cosine * cosine;", "= {} * cosine * cosine;"),
    "HAS_DIELECTRIC": ("bsdfs/dielectric.glsl", "cos_i = vertex.wo.z", "cos_i = {} * vertex.wo.z"),
    "HAS_ROUGH_GLASS": ("bsdfs/rough_dielectric.glsl", "vertex.eta * cos_o +", "{} * cos_o +"),
    "HAS_PRINCIPLED": ("bsdfs/principled.glsl", "chances.z * even", "{} * chances.z * even"),
    "HAS_COAT": ("bsdfs/principled.glsl", "chances.x * density", "{} * chances.x * density"),
    "HAS_TRANSMISSION": (
        "bsdfs/principled.glsl",
        "u >= gloss.coverage",
        "u >= {} * gloss.coverage",
    ),
    "HAS_PANE": ("bsdfs/pane.glsl", "2.0 * face /", "{} * face /"),
    "HAS_ATTENUATION": ("integrators/media.glsl", "absorption * distance", "{} * absorption"),
    "HAS_NESTED": (
        "integrators/media.glsl",
        "return glass_at(medium).ior",
        "return {} * glass_at(medium).ior",
    ),
    "HAS_LENS": ("integrators/camera.glsl", "camera.tan_lens * offset", "{} * offset"),
    "HAS_BACKGROUND": (
        "integrators/path.glsl",
        "path.throughput * background(",
        "{} * path.throughput * background(",
    ),
    "HAS_HORIZON": ("lights/sky.glsl", "abs(direction.y) *", "{} * abs(direction.y) *"),
    "HAS_SUN": ("lights/sun.glsl", "direction - frame.sun", "direction - {} * frame.sun"),
    "SAMPLE_SUN": ("lights/sun.glsl", "sample_cone(frame.sun_versine", "sample_cone({}"),
    "HAS_CONE": ("lights/emission.glsl", "0.5 * dot(aside, aside)", "{} * dot(aside, aside)"),
    "HAS_ONE_SIDED": (
        "lights/emission.glsl",
        "emitter.is_one_sided != 0",
        "{} * float(emitter.is_one_sided) != 0.0",
    ),
    "HAS_SPHERE_LIGHT": ("lights/sampling.glsl", "sample_cone(one_minus_cos,", "sample_cone({},"),
    "HAS_QUAD_LIGHT": ("lights/sampling.glsl", "share.x * quad.edge_u", "{} * quad.edge_u"),
    "HAS_DISK_LIGHT": ("lights/sampling.glsl", "vec3(place, 0.0)", "vec3({} * place, 0.0)"),
    "HAS_MESH_LIGHT": ("lights/sampling.glsl", "share_b * triangle.edge_b", "{} * triangle.edge_b"),
    "SAMPLE_LIGHTS": (
        "lights/sampling.glsl",
        "ray.direction = point.direction",
        "ray.direction = {} * point.direction",
    ),
    "WEIGHT_BOTH": ("integrators/path.glsl", "p_b / p_a", "{} * p_b / p_a"),
    "QUADS_BY_AREA": ("lights/sampling.glsl", "quad.width * quad.height", "{} * quad.width"),
    "MANY_LIGHTS": ("lights/choice.glsl", "rest < light.keep", "rest < {} * light.keep"),
    "ROULETTE": ("integrators/path.glsl", "throughput /= survival", "throughput /= {} + survival"),
}
ALWAYS = ("film/pixel.glsl", "1.0 / count", "{} / count")
NEEDED_TOO = {
    "HAS_SPHERE_TREE": {"HAS_SPHERE"},
    "HAS_TREE": {"HAS_DISK"},
    "HAS_CONDUCTOR": {"HAS_MIRROR"},
    "HAS_COAT": {"HAS_PRINCIPLED"},
    "HAS_TRANSMISSION": {"HAS_PRINCIPLED", "HAS_DIELECTRIC"},
    "SAMPLE_SUN": {"HAS_SUN"},
    "HAS_ROUGH_GLASS": {"HAS_DIELECTRIC"},
    "HAS_ATTENUATION": {"HAS_DIELECTRIC"},
    "HAS_NESTED": {"HAS_DIELECTRIC"},
    "HAS_SMOOTH": {"HAS_MESH"},
    "HAS_VERTEX_COLOR": {"HAS_MESH"},
    "HAS_ONE_SIDED": {"HAS_DISK"},
    "HAS_MESH_LIGHT": {"HAS_MESH", "SAMPLE_LIGHTS"},
    "HAS_HORIZON": {"HAS_BACKGROUND"},
    "HAS_SPHERE_LIGHT": {"HAS_SPHERE", "SAMPLE_LIGHTS"},
    "HAS_QUAD_LIGHT": {"HAS_QUAD", "SAMPLE_LIGHTS"},
    "HAS_DISK_LIGHT": {"HAS_DISK", "SAMPLE_LIGHTS"},
    "WEIGHT_BOTH": {"SAMPLE_LIGHTS", "HAS_SPHERE_LIGHT", "HAS_SPHERE"},
    "QUADS_BY_AREA": {"WEIGHT_BOTH", "SAMPLE_LIGHTS", "HAS_QUAD_LIGHT", "HAS_QUAD"},
    "SAMPLE_LIGHTS": {"HAS_SPHERE_LIGHT", "HAS_SPHERE"},
    "MANY_LIGHTS": {"SAMPLE_LIGHTS", "HAS_QUAD_LIGHT", "HAS_QUAD", "HAS_TREE"},
}

GONE_TOO = {
    "HAS_SPHERE": {"HAS_SPHERE_LIGHT", "HAS_SPHERE_TREE"},
    "HAS_BACKGROUND": {"HAS_HORIZON"},
    "HAS_PRINCIPLED": {"HAS_COAT", "HAS_TRANSMISSION"},
    "HAS_DIELECTRIC": {"HAS_ROUGH_GLASS", "HAS_ATTENUATION", "HAS_NESTED", "HAS_TRANSMISSION"},
    "HAS_QUAD": {"HAS_QUAD_LIGHT", "QUADS_BY_AREA"},
    "HAS_QUAD_LIGHT": {"QUADS_BY_AREA"},
    "HAS_DISK": {"HAS_DISK_LIGHT"},
    "HAS_MESH": {"HAS_MESH_LIGHT", "HAS_SMOOTH", "HAS_VERTEX_COLOR"},
    "WEIGHT_BOTH": {"QUADS_BY_AREA"},
    "QUADS_BY_AREA": {"WEIGHT_BOTH"},
    "SAMPLE_LIGHTS": {"HAS_SPHERE_LIGHT", "HAS_QUAD_LIGHT", "WEIGHT_BOTH", "MANY_LIGHTS"}
    | {"QUADS_BY_AREA", "HAS_DISK_LIGHT", "HAS_MESH_LIGHT", "SAMPLE_SUN"},
    "HAS_SUN": {"SAMPLE_SUN"},
}
GONE_TOO["SAMPLE_SUN"] = GONE_TOO["SAMPLE_LIGHTS"] - {"SAMPLE_SUN"} | {"SAMPLE_LIGHTS"}


def smallest_with(flag: str) -> set[str]:
    """The flags of the smallest scene that has this feature."""
    return {flag, "HAS_PLANE"} | NEEDED_TOO.get(flag, set())


def all_but(flag: str) -> set[str]:
    """The flags of the richest scene without this feature: what rests on it goes too."""
    return FLAGS - {flag} - GONE_TOO.get(flag, set())


SETS = {
    "everything": FLAGS,
    **{f"smallest with {flag}": smallest_with(flag) for flag in sorted(FLAGS)},
    **{f"all but {flag}": all_but(flag) for flag in sorted(FLAGS)},
}
MATERIALS: dict[str, dict[str, Any]] = {
    "matte": MATTE,
    "mirror": {"type": "metal", "color": [1, 1, 1], "roughness": 0},
    "rough": {"type": "metal", "color": [1, 1, 1], "roughness": 0.5},
    "glass": glass(),
    "frosted": glass(roughness=0.5),
    "pane": glass(thin=True),
    "tinted": glass(attenuation_color=[0.5] * 3, attenuation_distance=1.0),
    "water": glass(1.33, priority=1),
    "plastic": {"type": "principled"},
    "painted": {"type": "principled", "clearcoat": 1.0},
    "wax": {"type": "principled", "transmission": 0.5, "roughness": 0},
    "lamp": lamp(),
    "spot": lamp(cone={"axis": [0, 1, 0]}),
}


def sky_with(flags: set[str]) -> dict[str, list[float]]:
    """The background that asks for these features."""
    color = [1.0 if "HAS_BACKGROUND" in flags else 0.0] * 3
    return dict.fromkeys(
        ("bottom", "horizon", "top") if "HAS_HORIZON" in flags else ("color",), color
    )


def _flat_shape(flags: set[str]) -> dict[str, Any]:
    """Of a kind that is there anyway."""
    if "HAS_DISK" in flags:
        return disk([0, 0, 0], [1, 0, 0], 1, "matte")
    return quad([0, 0, 0], [1, 0, 0], [0, 1, 0], "matte")


def _triangle(material: str, flags: set[str]) -> dict[str, Any]:
    faces = np.eye(3), np.array([[0, 1, 2]])
    colors = np.eye(3) if "HAS_VERTEX_COLOR" in flags else None
    return mesh(faces, material, smooth="HAS_SMOOTH" in flags, colors=colors)


def _cone_lamp(flags: set[str]) -> dict[str, Any]:
    """Of a kind that is not sampled."""
    if "HAS_PLANE" in flags:
        return plane([0, -2, 0], [0, 1, 0], "spot")
    return box([0, 0, 0], [1, 1, 1], "spot")


def _one_sided(flags: set[str]) -> dict[str, Any]:
    """Of a kind that is sampled anyway, where there is one."""
    if "HAS_QUAD_LIGHT" in flags:
        return quad([0, 3, 0], [1, 0, 0], [0, 0, 1], "lamp") | {"emission_side": "front"}
    return disk([0, 3, 0], [0, 1, 0], 1, "lamp") | {"emission_side": "front"}


def needs_with(flags: set[str]) -> Needs:
    """What a scene and settings need that ask for these features."""

    def body(material: str) -> dict[str, Any]:
        if "HAS_SPHERE" in flags:
            return sphere([0, 0, -3], 1, material)
        return plane([0, 0, -3], [0, 0, 1], material)

    made_of = {"HAS_MIRROR": "mirror", "HAS_ROUGH_METAL": "rough", "HAS_DIELECTRIC": "glass"}
    made_of |= {"HAS_ROUGH_GLASS": "frosted", "HAS_PANE": "pane"}
    made_of |= {"HAS_PRINCIPLED": "plastic", "HAS_COAT": "painted", "HAS_TRANSMISSION": "wax"}
    made_of |= {"HAS_ATTENUATION": "tinted", "HAS_NESTED": "water"}
    objects = [body(name) for flag, name in made_of.items() if flag in flags]
    objects += [body("matte")] if "HAS_SPHERE" in flags else []
    ball, flat = sphere([9, 9, 9], 1, "matte"), _flat_shape(flags)
    objects += [ball] * (SPHERES_FROM if "HAS_SPHERE_TREE" in flags else 0)
    objects += [flat] * (TREE_FROM if "HAS_TREE" in flags else 0)
    objects += [plane([0, -1, 0], [0, 1, 0], "matte")] if "HAS_PLANE" in flags else []
    objects += [quad([0, 0, 0], [1, 0, 0], [0, 1, 0], "matte")] if "HAS_QUAD" in flags else []
    objects += [disk([0, 0, 0], [1, 0, 0], 1, "matte")] if "HAS_DISK" in flags else []
    objects += [_cone_lamp(flags)] if "HAS_CONE" in flags else []
    objects += [_one_sided(flags)] if "HAS_ONE_SIDED" in flags else []
    objects += [box([0, 0, 0], [1, 1, 1], "matte")] if "HAS_BOX" in flags else []
    tube = cylinder([0, 0, 0], [1, 1, 1], 1, "matte")
    objects += [tube] if "HAS_CYLINDER" in flags else []
    objects += [_triangle("matte", flags)] if "HAS_MESH" in flags else []
    lamps = [sphere([0, 2, 0], 0.5, "lamp")] if "HAS_SPHERE_LIGHT" in flags else []
    lamps += [_triangle("lamp", flags)] if "HAS_MESH_LIGHT" in flags else []
    lit = "HAS_QUAD_LIGHT" in flags
    lamps += [quad([0, 3, 0], [1, 0, 0], [0, 0, 1], "lamp")] if lit else []
    lamps += [disk([0, 3, 0], [0, 1, 0], 1, "lamp")] if "HAS_DISK_LIGHT" in flags else []
    many = lamps[-1:] if "HAS_TREE" in flags else lamps[:1]
    objects += lamps + many * (MOST_NEAR if "MANY_LIGHTS" in flags else 0)
    gold: dict[str, Any] = {"type": "metal", "preset": "gold"}
    metals = {"mirror": gold, "rough": {**gold, "roughness": 0.5}}
    scene = scene_of(
        objects,
        MATERIALS | (metals if "HAS_CONDUCTOR" in flags else {}),
        {"defocus_angle": 2.0 if "HAS_LENS" in flags else 0.0},
        background=sky_with(flags),
        **({"sun": {"elevation": 40, "irradiance": [1, 1, 1]}} if "HAS_SUN" in flags else {}),
    )
    samples = bool(flags & {"SAMPLE_LIGHTS", "SAMPLE_SUN"})
    method = "mis" if "WEIGHT_BOTH" in flags else "nee" if samples else "naive"
    settings = settings_for(scene.render, method=method, roulette="ROULETTE" in flags)
    return needs_of(scene, settings)


@pytest.fixture
def probed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Shader files with a probe in every feature, and one that is always read."""
    copy = tmp_path / "shaders_glsl"
    shutil.copytree(folder("shaders_glsl"), copy)
    for name, (file, expression, probed) in {**PROBES, "ALWAYS": ALWAYS}.items():
        text = (copy / file).read_text()
        assert text.count(expression) == 1, f"{expression} in {file}"
        (copy / file).write_text(text.replace(expression, probed.format(f"probe_{name}")))
    scene = (copy / "structs/scene.glsl").read_text()
    uniforms = "".join(f"uniform float probe_{name};\n" for name in [*PROBES, "ALWAYS"])
    (copy / "structs/scene.glsl").write_text(uniforms + scene)
    monkeypatch.setattr(glsl, "folder", lambda name: tmp_path / name)


def test_every_feature_has_its_probe() -> None:
    assert PROBES.keys() == FLAGS


@pytest.mark.parametrize("name", SETS)
def test_a_scene_asks_for_the_features_that_it_uses(name: str) -> None:
    constants = needs_with(SETS[name]).constants()
    assert {flag for flag in FLAGS if constants[flag]} == SETS[name]


@pytest.mark.usefixtures("probed")
@pytest.mark.parametrize("name", SETS)
def test_a_feature_is_compiled_in_exactly_if_the_scene_uses_it(
    ctx: moderngl.Context, name: str
) -> None:
    kernel = Kernel(
        ctx,
        Source("trace.comp", needs_with(SETS[name]).constants(), texts=written_for_everything()),
    )
    found = {member for member in kernel.names if member.startswith("probe_")}
    kernel.release()
    assert found == {"probe_ALWAYS", *(f"probe_{flag}" for flag in SETS[name])}
