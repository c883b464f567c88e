"""`glrt inspect --kernel`: the text that the driver gets, which compiles as it stands."""

import re

import pytest

from glrt.core.resources import folder
from glrt.gpu.context import Context
from glrt.gpu.glsl import read, shader_files, with_precise_floats
from glrt.image.sources import load
from glrt.rendering.passes import Resolved
from glrt.rendering.renderer import Renderer
from tests.support.processes import glrt


@pytest.mark.slow
@pytest.mark.usefixtures("exact_kernels")
@pytest.mark.parametrize("pipeline", ["compute", "fragment"])
def test_the_printed_kernel_is_the_one_that_renders_and_compiles(
    context: Context, pipeline: Resolved
) -> None:
    told = glrt("inspect", "lamps", "--kernel", "--pipeline", pipeline, "--context", context.route)
    assert (told.returncode, told.stderr) == (0, "")
    renderer = Renderer(load("lamps"), context=context, tier="baked", pipeline=pipeline)
    vertex, printed = renderer.shaders[0].text, told.stdout
    assert printed == renderer.shaders[-1].text
    renderer.release()
    with context.gl as gl:
        if pipeline == "compute":
            gl.compute_shader(printed).release()
        else:
            gl.program(vertex_shader=vertex, fragment_shader=printed).release()


def test_it_names_files_and_lines() -> None:
    lines = glrt("inspect", "lamps", "--kernel").stdout.splitlines()
    markers = [m for line in lines if (m := re.fullmatch(r"// ([\w/]+\.\w+):(\d+)", line))]
    names = {str(path.relative_to(folder("shaders_glsl"))) for path in shader_files()}
    assert {marker[1] for marker in markers} <= names | {"scene_arrays.glsl"}
    assert {"trace.comp", "bsdfs/matte.glsl", "scene_arrays.glsl"} <= {m[1] for m in markers}
    marker = lines.index("// sampling/warp.glsl:1")
    text = with_precise_floats(read("sampling/warp.glsl")).splitlines()
    assert lines[marker + 1 : marker + 1 + len(text)] == text


@pytest.mark.parametrize(
    ("scene", "wanted", "line"),
    [
        ("methods/gap", ("on", "1"), "in   linked spheres  linked 1, 3 spheres"),
        ("methods/gap", ("on", "0"), "out  linked spheres  linked 0"),
        ("lamps", ("on", "1"), "out  linked spheres  no sphere of smooth glass or metal"),
    ],
)
def test_it_reports_through_how_many_spheres_particles_are_linked(
    scene: str, wanted: tuple[str, str], line: str
) -> None:
    caustics, linked = wanted
    told = glrt("inspect", scene, "--caustics", caustics, "--linked", linked)
    assert told.returncode == 0
    assert [found for found in told.stdout.splitlines() if found.startswith(line)] != []
