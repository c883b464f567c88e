"""Passes over pixels, and that every shader file is compiled by a test."""

import re

import moderngl
import pytest

from glrt.core.resources import folder
from glrt.gpu.glsl import Source, read, shader_files
from tests.gpu.test_glsl import FILES
from tests.support.driver_log import COMPUTE, FRAGMENT, VERTEX, warnings

TONEMAP_ENTRY = """
layout(local_size_x = 1) in;
#include "passes/tonemap.glsl"
layout(std430) buffer Data { vec4 data; };
void main() { data.rgb = expose_and_encode(data.rgb, data.a, int(data.g)); }
"""
DISPLAYS = [
    *("display", "weighting", "false_colors", "aov_view", "first_surface", "magnify"),
    *("edges", "evidence", "fade", "taa", "ataa"),
    *("reconstruct", "predict", "predictions", "upsample"),
]
DISPLAY_STAGES = {"display.vert": VERTEX, "display.frag": FRAGMENT}
TEMPORAL = (
    "least_squares",
    "wrls",
    "wrls_rows",
    "taa",
    "ataa",
    "upsample",
)  # by tests/rendering/history
PROBES = {  # by tests/shaders/test_probe_kernels.py
    *("probe_rays.comp", "probe_light.comp", "probe_distances.comp", "probe_place.comp"),
    *("probes/blend.glsl", "probes/first_met.glsl", "probes/place.glsl", "probes/solids.glsl"),
    "probes/turns.glsl",
    "structs/probes.glsl",
}


def test_every_shader_file_is_compiled_by_a_test() -> None:
    root = folder("shaders_glsl")
    files = {str(path.relative_to(root)) for path in shader_files()}
    by_structs = re.findall(r'#include "([^"]+)"', read("structs/scene.glsl"))
    assert files == {*FILES, *by_structs} | {
        *("trace.glsl", "aov.glsl", "shapes/all_shapes.glsl", "integrators/first_hit.glsl"),
        *("integrators/aov_numbers.glsl", "passes/color_scale.glsl"),
        *("aov.comp", "aov.frag", "aov_view.frag", "first_surface.frag", "magnify.frag"),
        *("terms.comp", "terms.frag", "film/term_pixels.glsl"),
        *("particles.comp", "splats.comp", "integrators/particles.glsl", "film/splat_unit.glsl"),
        *("integrators/particle_start.glsl", "integrators/camera_links.glsl"),
        "integrators/light_links.glsl",
        *("trace.comp", "adaptive.comp", "paths.comp", "structs/path_records.glsl"),
        *("passes/tiles.glsl", "passes/tonemap.glsl", "sampling/other_hash.glsl"),
        *("raster.glsl", "raster.vert", "raster.frag"),  # by tests/rendering/test_raster.py
        *("trace.vert", "trace.frag", "weighting.frag", "false_colors.frag"),
        *("surfaces.glsl", "surfaces.comp", "surfaces.frag", "integrators/middle_ray.glsl"),
        *("integrators/middle_surface.glsl", "integrators/middle_volume.glsl"),
        *("media/bounds.glsl", "passes/surface_flags.glsl"),
        *("edges.frag", "reproject.frag", "passes/reprojection.glsl", "fade.frag", "evidence.frag"),
        *("taa.frag", "bring_models.frag", "reconstruct.frag", "predict.frag", "predictions.frag"),
        *(f"temporal/{name}.glsl" for name in TEMPORAL),
        *("ataa_mask.frag", "ataa.frag", "upsample.frag", "gather.comp", "more.comp"),
        *("silhouette.vert", "silhouette.frag", "silhouette_line.frag"),  # by tests/view
        *("deformed.vert", "deformed.frag"),
        *("probe_balls.vert", "probe_balls.frag", "passes/probe_balls.glsl"),
        *DISPLAY_STAGES,
        *PROBES,
    }


def test_tone_mapping_compiles_without_a_warning(ctx: moderngl.Context) -> None:
    assert warnings((COMPUTE, Source("tonemap", texts={"tonemap": TONEMAP_ENTRY}).live.text)) == []


@pytest.mark.parametrize("name", DISPLAYS)
def test_the_display_compiles_without_a_warning(ctx: moderngl.Context, name: str) -> None:
    assert ctx.version_code >= 430
    stages = [
        (VERTEX, Source("display.vert").live.text),
        (FRAGMENT, Source(f"{name}.frag").live.text),
    ]
    assert warnings(*stages) == []


@pytest.mark.parametrize("name", ["reproject", "ataa_mask", "bring_models"])
@pytest.mark.parametrize("has_deformed", [False, True], ids=["stiff", "deformed"])
def test_passes_to_another_view_compile_without_a_warning(
    ctx: moderngl.Context, name: str, has_deformed: bool
) -> None:
    assert ctx.version_code >= 430
    constants = {"HAS_DEFORMED": has_deformed}
    shader = Source(f"{name}.frag", constants).live.text
    assert warnings((VERTEX, Source("display.vert").live.text), (FRAGMENT, shader)) == []


@pytest.mark.parametrize("name", ["probe_balls", "deformed"])
def test_what_is_drawn_from_corners_compiles_without_a_warning(
    ctx: moderngl.Context, name: str
) -> None:
    assert ctx.version_code >= 430
    stages = ((VERTEX, "vert"), (FRAGMENT, "frag"))
    assert warnings(*((kind, Source(f"{name}.{stage}").live.text) for kind, stage in stages)) == []
