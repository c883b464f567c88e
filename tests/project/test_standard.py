"""The shaders by the front end of the GLSL standard's own authors: drivers differ in what they let
pass, and a computer has one of them."""

import shutil
import subprocess
from collections.abc import Iterator
from typing import Any

import pytest

from glrt.gpu.glsl import Source, read
from glrt.gpu.struct_arrays import MOST_UNIFORM_BYTES
from glrt.rendering.passes import PARTICLES, PATHS, SPLATS, Resolved, aov_pass
from glrt.rendering.pipelines import Tier, sources
from glrt.settings import Aov
from tests.support.builders import EVERYTHING, FEATURE_SETS
from tests.support.kernel_text import written_for
from tests.support.system_packages import needs_package

WAYS: dict[str, tuple[Tier, int]] = {
    "uniform blocks": ("generic", MOST_UNIFORM_BYTES),
    "textures": ("generic", 0),
    "constants": ("complete", MOST_UNIFORM_BYTES),
}
PIPELINES: tuple[Resolved, ...] = "compute", "fragment"
WARP = "sampling/warp.glsl"
ES = "320 es"  # knows no implicit conversion
PRECISIONS = " ".join(
    f"precision highp {kind};"
    for kind in ("float", "int", "image2D", "sampler2D", "isampler2D", "usampler2D")
)
DRAWN = (
    "display.frag",
    "weighting.frag",
    "false_colors.frag",
    "aov_view.frag",
    "first_surface.frag",
    "magnify.frag",
)
# The driver compiles all of them in tests/shaders; here, those with the most and the least text.
SETS = [
    name if name in ("everything", "nothing") else pytest.param(name, marks=pytest.mark.slow)
    for name in FEATURE_SETS
]
LAYERINGS: list[dict[str, Any]] = [{"LAYERS": 6}, {"LAYERS": 3, "BY_LENGTH": True}]


@pytest.fixture(autouse=True)
def validator() -> None:
    needs_package(bool(shutil.which("glslangValidator")), "glslang-tools")


def objections(shader: Source) -> Iterator[str]:
    """The objections of glslang to a shader, and to its live code, led back to its files."""
    entry = shader.whole.lines[-1].origin.rpartition(":")[0]
    command = ["glslangValidator", "--stdin", "-S", entry.rpartition(".")[2]]
    for code in (shader.whole, shader.live):
        done = subprocess.run(command, input=code.text, capture_output=True, text=True, timeout=250)
        for line in done.stdout.splitlines():
            if line != "stdin":
                yield code.explain(line)
        yield from done.stderr.splitlines()
        assert done.returncode == 0 or done.stdout.count("ERROR")


def in_es(constants: dict[str, bool | int], texts: dict[str, str] | None = None) -> Source:
    """The compute kernel as OpenGL ES would have it: there no function hides a built-in one."""
    main = f"{PRECISIONS}\n{read('trace.comp')}"
    given = {"trace.comp": main, "sampling/dot.glsl": "", **written_for(), **(texts or {})}
    return Source("trace.comp", constants, ES, given)


@pytest.mark.parametrize("features", SETS)
def test_every_kernel_is_within_the_standard(features: str) -> None:
    shaders = sources("compute", FEATURE_SETS[features], written_for())
    shaders += sources("fragment", FEATURE_SETS[features], written_for())
    assert [line for shader in shaders for line in objections(shader)] == []


@pytest.mark.parametrize(
    "aovs", [("albedo", "normal"), ("depth", "position"), ("object",), ("bounces",)]
)
def test_aovs_are(aovs: tuple[Aov, ...]) -> None:
    shaders = [
        shader
        for pipeline in PIPELINES
        for shader in sources(pipeline, EVERYTHING, written_for(), aov_pass(aovs))
    ]
    assert [line for shader in shaders for line in objections(shader)] == []


@pytest.mark.parametrize("features", SETS)
@pytest.mark.parametrize("entry", ["raster.vert", "raster.frag"])
def test_rasters_are(entry: str, features: str) -> None:
    shader = Source(entry, FEATURE_SETS[features], "410 core", written_for())
    assert list(objections(shader)) == []


def test_particles_and_records_of_paths_are() -> None:
    constants = {**EVERYTHING, "CASTERS": 5, "LINKED": 5, "TARGETS": 2}
    for render_pass in (PARTICLES, SPLATS, PATHS):
        (shader,) = sources("compute", constants, written_for(), render_pass)
        assert list(objections(shader)) == []


@pytest.mark.parametrize("pipeline", PIPELINES)
@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize("scene", ["cornell", "weekend"])
def test_every_way_to_read_a_scene_is(scene: str, way: str, pipeline: Resolved) -> None:
    shaders = sources(pipeline, EVERYTHING, written_for(scene, *WAYS[way]))
    assert [line for shader in shaders for line in objections(shader)] == []


@pytest.mark.parametrize("layers", LAYERINGS, ids=["groups", "lengths"])
def test_layers_are(layers: dict[str, Any]) -> None:
    assert (
        list(objections(Source("trace.comp", {**EVERYTHING, **layers}, texts=written_for()))) == []
    )


@pytest.mark.parametrize(
    "name",
    [
        *("display.vert", "display.frag", "weighting.frag", "false_colors.frag"),
        *("probe_balls.vert", "probe_balls.frag"),
    ],
)
def test_the_display_is(name: str) -> None:
    assert list(objections(Source(name))) == []


@pytest.mark.parametrize("features", SETS)
def test_no_kernel_converts_integers_silently(features: str) -> None:
    assert list(objections(in_es(FEATURE_SETS[features]))) == []


def test_a_field_that_some_compilers_take_for_a_method_is_seen() -> None:
    line = "struct Strip { float length; }; float f(Strip s) { return s.length / 2.0; }"
    found = list(objections(Source("trace.comp", EVERYTHING, texts={WARP: line, **written_for()})))
    assert f"{WARP}:1: 'length'" in found[0]


def test_a_silent_conversion_is_seen() -> None:
    found = list(objections(in_es(EVERYTHING, {WARP: "float one() { return 1; }"})))
    assert f"{WARP}:1:" in found[0]
    assert "conver" in found[0]
