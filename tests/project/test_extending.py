"""docs/extending.md: its steps, applied to a copy of the repository exactly as they stand there."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path
from typing import NamedTuple

import pytest

from glrt.packing.scene_tree import FAMILIES
from glrt.scene.shapes.kinds import KINDS, SAMPLED
from tests.support import lamp_kinds, shape_kinds

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "extending.md").read_text()


class Step(NamedTuple):
    """A place and the text that goes there."""

    file: str
    place: str  # "new file", "before" or "in place of"
    mark: str  # the line that the text comes before, or in whose place
    text: str


def steps_of(section: str) -> list[Step]:
    """The steps of a section of the page, in their order."""
    part = re.search(rf"^## {section}.*?(?=^## |\Z)", PAGE, re.MULTILINE | re.DOTALL)
    assert part
    step = re.compile(
        r"In (?:the (new file) )?`([\w./]+)`(?:, (before|in place of) `(.+?)`)?:\n\n"
        r"```\w+\n(.*?)```",
        re.DOTALL,
    )
    found = [Step(m[2], m[1] or m[3], m[4] or "", m[5]) for m in step.finditer(part[0])]
    assert len(found) == part[0].count("```") // 2, "every block of code is a step"
    return found


def steps_before(section: str) -> list[Step]:
    """The steps of the section on which this one builds."""
    return steps_of(BEFORE[section]) if section in BEFORE else []


def apply(tree: Path, step: Step) -> None:
    """Take one step in a copy; the mark must stand there once."""
    path = tree / step.file
    if step.place == "new file":
        assert not path.exists()
        path.write_text(step.text)
        return
    text = path.read_text()
    assert text.count(step.mark) == 1, f"{step.mark} in {step.file}"
    new = step.text + step.mark if step.place == "before" else step.text.rstrip("\n")
    path.write_text(text.replace(step.mark, new))


def extended(tree: Path, steps: list[Step]) -> Path:
    """A copy of the repository in which steps are taken."""
    ignored = shutil.ignore_patterns("__pycache__")
    for name in ("glrt", "shaders_glsl", "scenes"):
        shutil.copytree(ROOT / name, tree / name, ignore=ignored)
    for step in steps:
        apply(tree, step)
    return tree


def run(tree: Path, program: str) -> "subprocess.CompletedProcess[str]":
    """A program that imports glrt from the copy."""
    return subprocess.run(
        [sys.executable, "-P", "-W", "error", "-c", program],
        cwd=tree,
        env={**os.environ, "PYTHONPATH": str(tree)},
        capture_output=True,
        text=True,
        timeout=120,
    )


# A ring that shines, seen from 4 away: its share of the frame is its area over that of the frame.
ANNULUS = """
import math
import glrt
import numpy as np
from glrt.scene.scenefile.toml import parse_scene
from glrt.view.edits.new_objects import with_new
from glrt.view.viewport.outline import outline
from glrt.view.viewport.pick import pick
from glrt.view.viewport.transform import scaled, shifted

ring = {"shape": "annulus", "center": [0.0, 0.0, 0.0], "normal": [0.0, 0.0, 2.0], "inner": 0.5,
        "outer": 1.0, "material": "lamp", "name": "ring"}
scene = parse_scene({
    "camera": {"position": [0.0, 0.0, 4.0], "look_at": [0.0, 0.0, 0.0], "fov": 40.0},
    "materials": {"lamp": {"type": "light", "emission": [1.0, 1.0, 1.0]},
                  "white": {"type": "lambertian", "color": [0.5, 0.5, 0.5]}},
    "objects": [ring, {**ring, "center": [0.0, 0.0, -9.0], "material": "white"},
                {"shape": "sphere", "center": [9.0, 9.0, -9.0], "radius": 0.1,
                 "material": "white"}],
}, "rings")
edge = 2 * 4 * math.tan(math.radians(20))
expected = math.pi * (1 - 0.25) / edge**2
pictures = {
    (tier, pipeline): glrt.Renderer(scene, tier=tier, pipeline=pipeline, width=64, height=64,
                                    bounces=0, samples=64).render().image().radiance
    for tier in ("complete", "generic") for pipeline in ("compute", "fragment")
}
first, *others = pictures.values()
assert all((first == other).all() for other in others)
assert abs(first.mean() / expected - 1) < 0.01, (first.mean(), expected)
raster = glrt.render(scene, width=64, height=64, bounces=0, samples=64, method="hybrid",
                     effects=())
assert (raster.radiance == first).all(), "a raster finds what rays find"
lit = glrt.render(scene, samples=16, width=32, height=32, method="mis")
assert lit.radiance.mean() > first.mean()
away = [{**ring, "center": [0.0, float(k), 40.0], "name": None} for k in range(40)]
data = scene.model_dump(by_alias=True, exclude_none=True)
many = parse_scene({**data, "objects": [*data["objects"], *away]}, "many rings")
found = glrt.Renderer(many, width=64, height=64, bounces=0, samples=64).render().image()
assert (found.radiance == first).all(), "a tree finds what the loop finds"
aovs = glrt.render(scene, samples=32, width=32, height=32, aov=("depth",)).aovs
assert abs(float(aovs["depth"].value[16, 24].mean()) - 4.0) < 0.01
seen = pick(scene, 1.0, 0.5, 0.5 + 0.75 / edge)
assert seen and seen.number == 0
assert pick(scene, 1.0, 0.5, 0.5) is None
drawn = outline(scene.objects[0], scene.camera, 1.0)
assert len(drawn) == 128, "an outer and an inner rim, and no edge between them"
assert abs(float(np.abs(drawn[..., 0] - 0.5).max()) - 1.0 / edge) < 1e-6
added = with_new(scene, "annulus", (0.0, 0.0, 0.0), 0.5)
assert added.objects[-1].outer == 0.5
big = scaled(shifted(scene.objects[0], [1.0, 0.0, 0.0]), 2.0)
assert (big.center, big.inner, big.outer) == ((1.0, 0.0, 0.0), 1.0, 2.0)
"""

# A ring of radiance 1 shines down from 1 above a floor of albedo 0.5: on its axis the floor has
# 0.5 (R^2 / (R^2 + 1) - r^2 / (r^2 + 1)), the light of a disk without that of a smaller one.
RING_LIGHT = """
import glrt
from glrt.scene.scenefile.toml import parse_scene

floor = {"shape": "plane", "point": [0.0, 0.0, 0.0], "normal": [0.0, 1.0, 0.0], "material": "white"}
ring = {"shape": "annulus", "center": [0.0, 1.0, 0.0], "normal": [0.0, -1.0, 0.0], "inner": 0.5,
        "outer": 1.0, "material": "lamp"}
ball = {"shape": "sphere", "center": [0.0, 0.4, 0.0], "radius": 0.2, "material": "mirror"}
panel = {"shape": "quad", "corner": [3.0, 0.5, 0.0], "edge_u": [1.0, 0.0, 0.0],
         "edge_v": [0.0, 0.0, 1.0], "material": "lamp"}
data = {
    "camera": {"position": [0.0, 0.9, 0.4], "look_at": [0.0, 0.0, 0.0], "fov": 0.1},
    "materials": {"lamp": {"type": "light", "emission": [1.0, 1.0, 1.0]},
                  "white": {"type": "lambertian", "color": [0.5, 0.5, 0.5]},
                  "mirror": {"type": "metal", "color": [1.0, 1.0, 1.0], "roughness": 0.0}},
    "objects": [floor, ring],
}
expected = 0.5 * (1 / 2 - 0.25 / 1.25)
alone = parse_scene(data, "ring")
for method in ("naive", "nee", "mis", "cook"):
    seen = glrt.render(alone, samples=256, width=16, height=16, bounces=1, method=method)
    assert abs(seen.radiance.mean() / expected - 1) < 0.02, (method, seen.radiance.mean())
area = 3.14159265 * (1 - 0.25)
point = glrt.render(alone, samples=16, width=16, height=16, bounces=1, method="phong")
assert abs(point.radiance.mean() / (0.5 * area / 3.14159265) - 1) < 0.01, point.radiance.mean()
data["camera"] = {"position": [0.0, 0.9, 3.0], "look_at": [0.0, 0.2, 0.0], "fov": 30.0}
data["objects"] = [floor, ring, ball, panel]
lit = parse_scene(data, "ring, panel and ball")
wide = dict(samples=1024, width=24, height=24)
plain = glrt.render(lit, method="naive", **wide)
for more in ({}, {"caustics": "on"}):
    found = glrt.render(lit, method="mis", seed=1, **more, **wide)
    verdict = glrt.compare(found, plain)
    assert verdict, (more, verdict)
both = [{**ring, "emission_side": "front"}, {**ring, "center": [0.0, 2.0, 0.0]}]
data["objects"] = [floor, *both, ball]
pictures = [
    glrt.render(parse_scene(data, "rings"), method=method, seed=seed, **more, **wide)
    for seed, (method, more) in enumerate((("naive", {}), ("mis", {}), ("mis", {"caustics": "on"})))
]
for found in pictures[1:]:
    assert glrt.compare(found, pictures[0]), glrt.compare(found, pictures[0])
lamps = [{**ring, "center": [0.5 * k, 4.0, -3.0]} for k in range(40)]
data["objects"] = [floor, *lamps]
pictures = [glrt.render(parse_scene(data, "many rings"), method=method, seed=seed, **wide)
            for seed, method in enumerate(("naive", "mis"))]
assert glrt.compare(*pictures), glrt.compare(*pictures)
"""

# Under an even sky, from 60 degrees off the normal: (1 - cos) / 3 of it.
VELVET = """
import glrt
from glrt.scene.scenefile.toml import parse_scene

scene = parse_scene({
    "camera": {"position": [0.0, 0.5, 0.8660254], "look_at": [0.0, 0.0, 0.0], "fov": 0.1},
    "background": {"color": [1.0, 1.0, 1.0]},
    "materials": {"cloth": {"type": "velvet", "color": [1.0, 0.5, 0.25]}},
    "objects": [{"shape": "plane", "point": [0.0, 0.0, 0.0], "normal": [0.0, 1.0, 0.0],
                 "material": "cloth"}],
}, "cloth")
for method in ("naive", "mis"):
    mean = glrt.render(scene, samples=256, width=32, height=32, method=method).radiance.mean((0, 1))
    for found, color in zip(mean, (1.0, 0.5, 0.25)):
        assert abs(found / (color * 0.5 / 3) - 1) < 0.01, mean
lamp = {"type": "light", "emission": [4.0, 4.0, 4.0]}
lit = scene.model_dump(exclude_none=True)
lit["materials"]["lamp"] = lamp
lit["objects"] = [*lit["objects"], {"shape": "sphere", "center": [1.0, 1.0, 0.0], "radius": 0.3,
                                    "material": "lamp"}]
lit = parse_scene(lit, "lit")
pictures = [glrt.render(lit, samples=1024, width=16, height=16, method=m) for m in ("naive", "mis")]
assert glrt.compare(*pictures), glrt.compare(*pictures)
"""
PROGRAMS = {"A shape": ANNULUS, "A light": RING_LIGHT, "A material": VELVET}
BEFORE = {"A light": "A shape"}  # the section whose steps come first
LAMPS = {"A light": (*SAMPLED, "annulus")}  # kinds of lamps after the steps


@pytest.mark.slow_cases("A light")
@pytest.mark.parametrize("section", PROGRAMS)
def test_the_steps_suffice(section: str, tmp_path: Path) -> None:
    done = run(extended(tmp_path, steps_before(section) + steps_of(section)), PROGRAMS[section])
    assert done.returncode == 0, done.stderr
    assert nameless(section, tmp_path / "shaders_glsl") == []


@pytest.mark.slow
@pytest.mark.parametrize(
    ("section", "left_out"),
    [(section, n) for section in PROGRAMS for n in range(len(steps_of(section)))],
)
def test_a_step_that_is_left_out_is_an_error(section: str, left_out: int, tmp_path: Path) -> None:
    """It fails at import, at compilation, or in the picture: nothing falls back to a default."""
    steps = steps_of(section)
    if steps[left_out].file.endswith("__init__.py"):
        pytest.skip("tests/project/test_architecture.py reads the lists of modules")
    kept = steps_before(section) + steps[:left_out] + steps[left_out + 1 :]
    done = run(extended(tmp_path, kept), PROGRAMS[section])
    shaders = tmp_path / "shaders_glsl"
    assert done.returncode != 0 or nameless(section, shaders), steps[left_out]


def nameless(section: str, shaders: Path) -> list[str]:
    """Kinds that a function or file of the shaders does not name after a section, as it must."""
    found = [*nameless_kinds(shaders), *lamp_kinds.unnamed(LAMPS.get(section, ()), shaders)]
    if section == "A material":
        return found
    leaves = [name.lower() for name in FAMILIES]
    more = shape_kinds.unnamed([*KINDS, "annulus"], [*leaves, "annulus"], shaders)
    return [*found, *more]


def nameless_kinds(shaders: Path) -> list[str]:
    """Kinds of materials that a function of bsdfs/material.glsl does not name, as it must.

    Each in `sample_material` and, unless `is_delta` names it, in `eval_material` and
    `pdf_material`; MATTE is what remains.
    """
    kinds = re.findall(r"^const int (\w+) =", (shaders / "structs/material.glsl").read_text(), re.M)
    text = (shaders / "bsdfs/material.glsl").read_text()
    bodies = dict(re.findall(r"^\w+ (\w+)\([^{]*\{(.*?)^\}", text, re.MULTILINE | re.DOTALL))
    found = []
    for kind in kinds:
        is_delta = f"if (HAS_{kind} && material.kind == {kind}) return true" in bodies["is_delta"]
        names = ["sample", *([] if is_delta else ["eval", "pdf"])]
        missing = [n for n in names if not re.search(rf"\b{kind}\b", bodies[f"{n}_material"])]
        is_chosen = kind not in ("MATTE", "NONE")  # the kind that is left, and no surface
        found += [f"{kind}: {name}_material" for name in missing if is_chosen]
    return found


def test_every_kind_of_material_is_named_where_one_is_chosen(tmp_path: Path) -> None:
    assert nameless_kinds(ROOT / "shaders_glsl") == []
    steps = [step for step in steps_of("A material") if "return pdf_matte" not in step.mark]
    assert nameless_kinds(extended(tmp_path / "less", steps) / "shaders_glsl") == [
        "VELVET: pdf_material"
    ]
