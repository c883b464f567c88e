"""`glrt inspect`: features, what can go, and the text that the driver gets, which compiles."""

import re
from pathlib import Path

import pytest

from glrt.cli.main import main
from glrt.core.resources import folder
from glrt.gpu.context import Context
from glrt.gpu.glsl import read, shader_files, with_precise_floats
from glrt.image.sources import load
from glrt.rendering.passes import Resolved
from glrt.rendering.renderer import Renderer
from glrt.scene.scene import Scene
from tests.support.builders import MATTE, sphere
from tests.support.processes import glrt


@pytest.mark.slow
@pytest.mark.usefixtures("exact_kernels")
@pytest.mark.parametrize("pipeline", ["compute", "fragment"])
def test_the_printed_kernel_is_the_one_that_renders_and_compiles(
    context: Context, pipeline: Resolved
) -> None:
    told = glrt("inspect", "lamps", "--kernel", "--pipeline", pipeline, "--context", context.route)
    assert (told.returncode, told.stderr) == (0, "")
    renderer = Renderer(load("lamps"), context=context, tier="complete", pipeline=pipeline)
    vertex, printed = renderer.shaders[0].live.text, told.stdout
    assert printed == renderer.shaders[-1].live.text
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
    ("scene", "wanted", "words"),
    [
        ("methods/gap", ("on", "1"), "in linked spheres linked 1, 3 spheres"),
        ("methods/gap", ("on", "0"), "out linked spheres linked 0"),
        ("lamps", ("on", "1"), "out linked spheres no sphere of smooth glass or metal"),
    ],
)
def test_it_reports_through_how_many_spheres_particles_are_linked(
    scene: str, wanted: tuple[str, str], words: str, capsys: pytest.CaptureFixture[str]
) -> None:
    caustics, linked = wanted
    assert main(["inspect", scene, "--all", "--caustics", caustics, "--linked", linked]) == 0
    lines = [" ".join(line.split()) for line in capsys.readouterr().out.splitlines()]
    assert [line for line in lines if line.startswith(words)] != []


def test_features_come_first_and_the_rest_in_one_paragraph(
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert main(["inspect", "cornell"]) == 0
    text = capsys.readouterr().out
    assert re.findall(r"^in   (.*?)  ", text, re.MULTILINE)[:3] == ["spheres", "planes", "quads"]
    assert re.search("^out ", text, re.MULTILINE) is None
    assert "\n\nThe kernel leaves out disks, boxes, cylinders, meshes, " in text
    assert main(["inspect", "cornell", "--all"]) == 0
    whole = capsys.readouterr().out
    assert whole.index("\nin   Sobol points") < whole.index("\nout  disks")
    assert re.search("^out  textured color +no texture$", whole, re.MULTILINE)
    assert re.search("^out  mirrors +no metal of roughness 0$", whole, re.MULTILINE)
    assert re.search("^out  cones +no lamp with a cone$", whole, re.MULTILINE)


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ("--simplify", "--simplify needs the change that is allowed: give --error"),
        ("--error 2% --apply -o b.toml", "--apply writes what --simplify finds"),
        ("--simplify --error 2% --apply", "--apply and -o FILE.toml go together"),
        ("--simplify --error 2% -o b.toml", "--apply and -o FILE.toml go together"),
        ("--simplify --error 2% --apply -o b.png", "must end in .toml"),
        ("--simplify --error 2% --apply -o room.toml", "is the scene itself"),
        ("--simplify --error 2% --apply -o none/b.toml", "there is no folder none"),
        ("--simplify --error 2% --kernel", "leave --simplify out"),
        ("--simplify --error 100%", "below 100 %"),
    ],
)
def test_simplify_refuses_what_does_not_go_together(
    options: str,
    said: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    scene = (folder("scenes") / "cornell.toml").read_text()
    Path("room.toml").write_text(scene)
    assert main(["inspect", "room.toml", *options.split()]) == 2
    told = capsys.readouterr()
    assert said in told.err
    assert (told.out, told.err.count("\n")) == ("", 1)
    assert Path("room.toml").read_text() == scene
    assert [path.name for path in tmp_path.iterdir()] == ["room.toml"]


@pytest.mark.slow
def test_the_smaller_scene_is_written_and_renders(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """A ball behind the camera and the bounces that nothing needs go; the rest stays."""
    source, smaller = tmp_path / "ball.toml", tmp_path / "smaller.toml"
    things = [sphere([0, 0, 0], 1, "white"), sphere([0, 0, 90], 1, "other")]
    materials = {"white": MATTE, "other": MATTE}
    eye = {"position": [0.0, 0.0, 4.0], "look_at": [0.0, 0.0, 0.0]}
    render = {"width": 32, "height": 32, "bounces": 6}
    sky = {"color": [1.0, 1.0, 1.0]}
    scene = Scene.build(eye, things, materials=materials, background=sky, render=render)
    scene.save(source)
    words = ["inspect", str(source), "--simplify", "--error", "1%", "--apply", "-o", str(smaller)]
    assert main(words) == 0
    text = capsys.readouterr().out
    assert "bounces beyond 1" in text
    assert "objects[1] (sphere)" in text
    found = load(smaller)
    assert (len(found.objects), [*found.materials], found.render.bounces) == (1, ["white"], 1)
    assert main([*words[:2], "--simplify", "--error", "0.0001%"]) == 0
