"""The kernel contains what its scene needs and nothing else.

A read of a uniform `probe_X` is planted into the text of every feature X. A linked program lists
the uniforms that it still reads; so `probe_X` stands in the list exactly if X is compiled in.
"""

import shutil
from pathlib import Path
from typing import Any
from unittest.mock import patch

import moderngl
import numpy as np
import pytest

from glrt.core.resources import folder
from glrt.gpu import glsl
from glrt.gpu.glsl import Source, read
from glrt.gpu.program import Kernel
from glrt.plan.facts import MOST_NEAR, REST_FROM, SPHERES_FROM, TREE_FROM, SceneFacts
from glrt.plan.features import Needs, needs_of
from glrt.scene import instancing
from glrt.scene.density import Density
from glrt.scene.medium import Medium
from glrt.scene.transfer import Transfer
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
from tests.support.feature_probes import ALWAYS, GONE_TOO, NEEDED_TOO, PROBES
from tests.support.kernel_text import written_for_everything
from tests.support.meshes import mesh

ONE_VOXEL = np.ones((1, 1, 1), np.float32)
FLAGS = {name for name, value in EVERYTHING.items() if value is True}


@pytest.fixture(autouse=True)
def _instances(monkeypatch: pytest.MonkeyPatch) -> None:
    """A triangle that is used twice has a tree of its own."""
    monkeypatch.setattr(instancing, "LEAST_SAVED", 1)


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
pytestmark = pytest.mark.usefixtures("twins_stay")  # of many objects the number matters
_CHECKER = {"checker": [0.25, 0.75]}
MATERIALS: dict[str, dict[str, Any]] = {
    "matte": MATTE,
    "mirror": {"type": "metal", "color": [1, 1, 1], "roughness": 0},
    "rough": {"type": "metal", "color": [1, 1, 1], "roughness": 0.5},
    "brushed": {"type": "metal", "color": [1, 1, 1], "roughness": 0.5, "anisotropy": 0.5},
    "glass": glass(),
    "frosted": glass(roughness=0.5),
    "bathroom": glass(roughness=0.5, thin=True),
    "pane": glass(thin=True),
    "tinted": glass(attenuation_color=[0.5] * 3, attenuation_distance=1.0),
    "water": glass(1.33, priority=1),
    "prism": glass(dispersion=1.0),
    "plastic": {"type": "principled"},
    "painted": {"type": "principled", "clearcoat": 1.0},
    "velvet": {"type": "principled", "sheen": [0.5, 0.5, 0.5]},
    "leaf": {"type": "principled", "diffuse_transmission": 0.5},
    "soapy": {"type": "principled", "iridescence": 1.0},
    "wax": {"type": "principled", "transmission": 0.5, "roughness": 0},
    "checked": {"type": "lambertian", "color": _CHECKER},
    "glowing": {"type": "principled", "emission": _CHECKER},
    "worn": {"type": "principled", "roughness": _CHECKER},
    "bumpy": {"type": "principled", "normal": {"image": "bumps.png"}},
    "torn": {"type": "principled", "alpha": _CHECKER},
    "gauze": {"type": "principled", "alpha": 0.5},
    "label": {"type": "principled", "transmission": _CHECKER, "roughness": 0.0},
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
    """A flat shape of a kind that is there anyway."""
    if "HAS_DISK" in flags:
        return disk([0, 0, 0], [1, 0, 0], 1, "matte")
    return quad([0, 0, 0], [1, 0, 0], [0, 1, 0], "matte")


def _triangle(material: str, flags: set[str]) -> dict[str, Any]:
    faces = np.eye(3), np.array([[0, 1, 2]])
    colors = np.eye(3) if "HAS_VERTEX_COLOR" in flags else None
    backs = "hidden" if "HAS_HIDDEN_BACK" in flags and material != "lamp" else "both"
    smooth = "HAS_SMOOTH" in flags
    return mesh(faces, material, smooth=smooth, colors=colors, backfaces=backs)


def _cone_lamp(flags: set[str]) -> dict[str, Any]:
    """A cone lamp of a kind that is not sampled."""
    if "HAS_PLANE" in flags:
        return plane([0, -2, 0], [0, 1, 0], "spot")
    return box([0, 0, 0], [1, 1, 1], "spot")


def _one_sided(flags: set[str]) -> dict[str, Any]:
    """A one-sided lamp of a kind that is sampled anyway, where there is one."""
    if "HAS_QUAD_LIGHT" in flags:
        return quad([0, 3, 0], [1, 0, 0], [0, 0, 1], "lamp") | {"emission_side": "front"}
    return disk([0, 3, 0], [0, 1, 0], 1, "lamp") | {"emission_side": "front"}


def needs_with(flags: set[str]) -> Needs:
    """The needs of a scene and settings that ask for these features."""

    def body(material: str) -> dict[str, Any]:
        if "HAS_SPHERE" in flags:
            return sphere([0, 0, -3], 1, material)
        return plane([0, 0, -3], [0, 0, 1], material)

    made_of = {"HAS_MIRROR": "mirror", "HAS_ROUGH_METAL": "rough", "HAS_DIELECTRIC": "glass"}
    made_of |= {"HAS_ROUGH_GLASS": "frosted", "HAS_PANE": "pane", "HAS_ANISOTROPY": "brushed"}
    made_of |= {"HAS_PRINCIPLED": "plastic", "HAS_COAT": "painted", "HAS_TRANSMISSION": "wax"}
    made_of |= {"HAS_ATTENUATION": "tinted", "HAS_NESTED": "water", "HAS_IRIDESCENCE": "soapy"}
    made_of |= {"HAS_NONE": "none", "HAS_COLOR_MAP": "checked", "HAS_EMISSION_MAP": "glowing"}
    made_of |= {"HAS_SHEEN": "velvet", "HAS_DISPERSION": "prism", "HAS_ROUGH_PANE": "bathroom"}
    made_of |= {"HAS_TRANSLUCENCY": "leaf"}
    made_of |= {"HAS_GLOSS_MAP": "worn", "HAS_NORMAL_MAP": "bumpy"}
    made_of |= {"HAS_COVERAGE_MAP": "torn", "HAS_HOLE": "gauze", "HAS_TRANSMISSION_MAP": "label"}
    objects = [body(name) for flag, name in made_of.items() if flag in flags]
    objects += [body("matte")] if "HAS_SPHERE" in flags else []
    ball, flat = sphere([9, 9, 9], 1, "matte"), _flat_shape(flags)
    objects += [ball] * (SPHERES_FROM if "HAS_SPHERE_TREE" in flags else 0)
    most = max(TREE_FROM, 6 * REST_FROM)  # enough for a tree with five kinds among triangles
    objects += [flat] * (most if "HAS_TREE" in flags else 0)
    objects += [plane([0, -1, 0], [0, 1, 0], "matte")] if "HAS_PLANE" in flags else []
    objects += [quad([0, 0, 0], [1, 0, 0], [0, 1, 0], "matte")] if "HAS_QUAD" in flags else []
    objects += [disk([0, 0, 0], [1, 0, 0], 1, "matte")] if "HAS_DISK" in flags else []
    objects += [_cone_lamp(flags)] if "HAS_CONE" in flags else []
    objects += [_one_sided(flags)] if "HAS_ONE_SIDED" in flags else []
    objects += [box([0, 0, 0], [1, 1, 1], "matte")] if "HAS_BOX" in flags else []
    tube = cylinder([0, 0, 0], [1, 1, 1], 1, "matte")
    objects += [tube] if "HAS_CYLINDER" in flags else []
    triangles = 2 if "HAS_INSTANCE" in flags else 1
    objects += [_triangle("matte", flags)] * triangles if "HAS_MESH" in flags else []
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
    if "HAS_MEDIA" in flags:
        grid = Density(ONE_VOXEL, min=(0, 0, 0), max=(1, 1, 1))
        shown = Transfer(values=[0], colors=[[1] * 3], opacities=[0.5], length=1)
        fog = Medium(
            density=grid if "HAS_GRID" in flags else None,
            transfer=shown if "HAS_TRANSFER" in flags else None,
        )
        scene = scene.model_copy(update={"media": {"fog": fog}, "medium": "fog"})
    samples = bool(flags & {"SAMPLE_LIGHTS", "SAMPLE_SUN"})
    method = "mis" if "WEIGHT_BOTH" in flags else "nee" if samples else "naive"
    settings = settings_for(
        scene.render,
        method=method,
        roulette="ROULETTE" in flags,
        caustics="on" if "HAS_PARTICLES" in flags else "off",
        linked=0.0,
    )
    with patch("glrt.plan.media.has_ranks", return_value=False):  # or no scene had all features
        return needs_of(SceneFacts(scene), settings)


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


def tenth(start: int) -> set[str]:
    """Each tenth feature, and the features that it needs."""
    found = set(sorted(FLAGS)[start::10])
    while more := {it for flag in found for it in NEEDED_TOO.get(flag, ())} - found:
        found |= more
    return found


def test_every_probe_has_one_place_in_the_shaders() -> None:
    for file, expression, _ in (*PROBES.values(), ALWAYS):
        assert read(file).count(expression) == 1, f"{expression} in {file}"


MIXED = {f"tenth {start}": tenth(start) for start in range(10)}


@pytest.mark.slow
@pytest.mark.usefixtures("probed")
@pytest.mark.parametrize(
    "name", [*MIXED, *(name for name in SETS if not name.startswith("all but"))]
)
def test_a_feature_is_compiled_in_exactly_if_the_scene_uses_it(
    ctx: moderngl.Context, name: str
) -> None:
    """Each alone, and some together: each is left out of some kernel that has others."""
    constants = needs_with(MIXED.get(name) or SETS[name]).constants()
    kernel = Kernel(ctx, Source("trace.comp", constants, texts=written_for_everything()))
    found = {member for member in kernel.names if member.startswith("probe_")}
    kernel.release()
    flags = {flag for flag in FLAGS if constants[flag]}
    assert name in MIXED or flags == SETS[name]
    assert found == {"probe_ALWAYS", *(f"probe_{flag}" for flag in flags)}


def test_every_feature_is_in_some_of_the_mixed_kernels_and_left_out_of_some() -> None:
    asked = [needs_with(flags).constants() for flags in MIXED.values()]
    counts = {flag: sum(bool(constants[flag]) for constants in asked) for flag in FLAGS}
    assert {flag for flag, count in counts.items() if not 0 < count < len(asked)} == set()
