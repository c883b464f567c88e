"""Kernel source: what is assembled, what the driver thinks of it, and where it says errors are."""

import re
import shutil
from pathlib import Path

import moderngl
import pytest

from glrt.core.errors import RenderError
from glrt.core.resources import folder
from glrt.gpu import glsl
from glrt.gpu.evaluate import path_files
from glrt.gpu.glsl import Line, Source, files_reread, read
from glrt.gpu.program import FragmentKernel, Kernel
from glrt.gpu.struct_arrays import FILE
from glrt.rendering.passes import PARTICLES, PATHS, SPLATS, SURFACES, RenderPass, aov_pass
from glrt.rendering.pipelines import sources
from tests.gpu.test_precise import computed_returns, imprecise
from tests.support.builders import EVERYTHING, FEATURE_SETS
from tests.support.driver_log import COMPUTE, FRAGMENT, VERTEX, warnings
from tests.support.kernel_text import written_for

INCLUDES = path_files()
FILES = [name for name in INCLUDES if name != FILE]
WRITTEN = written_for()
TOLD = pytest.param(PATHS, marks=pytest.mark.slow)
OF_PIXELS = [aov_pass(("albedo", "normal")), aov_pass(("depth", "position"))]
OF_PIXELS += [aov_pass(("object",)), aov_pass(("bounces",)), SURFACES]


@pytest.fixture
def shaders(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A copy of the shader folder, to plant faults in."""
    copy = tmp_path / "shaders_glsl"
    shutil.copytree(folder("shaders_glsl"), copy)
    monkeypatch.setattr(glsl, "folder", lambda name: tmp_path / name)
    return copy


def plant(file: Path, line: str) -> int:
    """Put a line in front of the file's second function; the number it has there."""
    lines = file.read_text().splitlines()
    starts = [i for i, text in enumerate(lines) if re.match(r"\w+ \w+\(.*\{", text)]
    lines.insert(starts[1], line)
    file.write_text("\n".join(lines))
    return starts[1] + 1


# --- assembling ----------------------------------------------------------------------------


def test_the_version_stands_first_and_the_prelude_follows() -> None:
    lines = Source(
        "trace.comp", {"HAS_LENS": False, "BLOCK": 16}, texts=WRITTEN
    ).whole.text.splitlines()
    assert lines[:3] == [
        "#version 430 core",
        "const bool HAS_LENS = false;",
        "const int BLOCK = 16;",
    ]


def test_a_file_is_included_once_where_it_is_first_named(shaders: Path) -> None:
    (shaders / "a.glsl").write_text('#include "b.glsl"\nint a;\n')
    (shaders / "b.glsl").write_text('#include "a.glsl"\nint b;\n')
    entry = '#include "a.glsl"\n#include "b.glsl"\nint entry;'
    source = Source("entry.comp", texts={"entry.comp": entry})
    lines = ["// b.glsl:2", "int b;", "// a.glsl:2", "int a;", "// entry.comp:3", "int entry;"]
    assert [line.text for line in source.whole.lines[1:]] == lines
    origins = ["b.glsl:2", "a.glsl:2", "entry.comp:3"]
    assert [line.origin for line in source.whole.lines] == [
        "prelude",
        *(o for o in origins for _ in "ab"),
    ]


def test_lines_are_assembled_once_while_files_and_constants_stay(
    shaders: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = shaders / "mine.glsl"
    file.write_text("int a;\n")
    entry = {"mine.comp": '#include "mine.glsl"\n'}

    def lines(**constants: bool | int) -> list[str]:
        source = Source("mine.comp", constants, texts=entry)
        return [line.text for line in source.whole.lines][1:]

    first = lines(A=1)
    expanded = list[str]()
    expand = glsl._Files.expand

    def noted(self: glsl._Files, name: str, wanted_by: str) -> list[Line]:
        expanded.append(name)
        return expand(self, name, wanted_by)

    monkeypatch.setattr(glsl._Files, "expand", noted)
    assert lines(A=1) == first
    assert expanded == []
    assert lines(A=True)[0] == "const bool A = true;"
    file.write_text("int b;\n")
    with files_reread():
        assert lines(A=1)[-1] == "int b;"


def test_no_include_is_left_for_the_driver() -> None:
    assert "#include" not in Source("trace.comp", EVERYTHING, texts=WRITTEN).whole.text


def test_a_missing_include_names_the_file_and_the_line_that_asks(shaders: Path) -> None:
    (shaders / "a.glsl").write_text('// one\n#include "lost.glsl"\n')
    with pytest.raises(RenderError, match=r"a\.glsl:2: .*'lost\.glsl': No such file"):
        _ = Source("entry.comp", texts={"entry.comp": '#include "a.glsl"\n'}).whole.text


def test_a_file_is_read_once_until_it_is_asked_for_again(shaders: Path) -> None:
    def text() -> str:
        return (
            Source("entry.comp", texts={"entry.comp": '#include "a.glsl"\n'}).whole.lines[-1].text
        )

    file = shaders / "a.glsl"
    file.write_text("int a;\n")
    assert text() == "int a;"
    file.write_bytes(b"int b; // \xff\n")
    assert text() == "int a;"
    with pytest.raises(RenderError, match="int b"), files_reread():
        raise RenderError(text())
    assert text() == "int a;"
    with files_reread():
        assert text() == "int b; // \ufffd"
    assert text() == "int b; // \ufffd"


# --- the driver's messages -----------------------------------------------------------------


@pytest.mark.parametrize("name", FILES)
def test_an_error_in_an_included_file_is_reported_by_file_and_line(
    ctx: moderngl.Context, shaders: Path, name: str
) -> None:
    (shaders / name).write_text("int first() { return 1; }\n\nint second() { return 2; }\n")
    number = plant(shaders / name, "int broken = undeclared;")
    source = Source(
        "entry.comp", EVERYTHING, texts={"entry.comp": f'#include "{name}"\nvoid main() {{}}'}
    )
    with pytest.raises(RenderError, match=rf"{re.escape(name)}:{number}: .*undeclared"):
        Kernel(ctx, source)


def test_an_error_deep_in_the_kernel_is_reported_by_file_and_line(
    ctx: moderngl.Context, shaders: Path
) -> None:
    number = plant(shaders / "lights/sampling.glsl", "int broken = undeclared;")
    with pytest.raises(
        RenderError, match=rf"lights/sampling\.glsl:{number}: .*undeclared"
    ) as caught:
        Kernel(ctx, Source("trace.comp", EVERYTHING, texts=WRITTEN))
    assert "\n" not in str(caught.value)


def test_an_error_in_the_entry_text_is_reported_under_its_name(ctx: moderngl.Context) -> None:
    text = "layout(local_size_x = 1) in;\nvoid main() {\n    undeclared = 1;\n}\n"
    with pytest.raises(RenderError, match=r"entry\.comp:3: .*undeclared"):
        Kernel(ctx, Source("entry.comp", texts={"entry.comp": text}))


@pytest.mark.parametrize(
    ("told", "led_back"),
    [
        ("0:3(14): error: `x' undeclared", "e.comp:1: error: `x' undeclared"),
        ("0(3) : error C1503: undefined", "e.comp:1: error C1503: undefined"),
        ("ERROR: 0:3: 'x' : undeclared", "ERROR: e.comp:1: 'x' : undeclared"),
        ("0:1(1): error: version", "prelude: error: version"),
        ("0:99(1): error: x", "line 99: error: x"),
        ("0:0(0): error: x", "line 0: error: x"),
        ("expected 10:3 or 0.5(3)", "expected 10:3 or 0.5(3)"),
    ],
    ids=["Mesa", "NVIDIA", "glslang", "prelude", "past the end", "nowhere", "no place"],
)
def test_messages_of_all_drivers_are_led_back_to_files(told: str, led_back: str) -> None:
    source = Source("e.comp", texts={"e.comp": "one\ntwo\nthree"})
    assert source.whole.explain(told) == led_back


def test_each_line_of_a_message_is_led_back() -> None:
    source = Source("e.comp", texts={"e.comp": "one\ntwo\nthree"})
    told = "0:3(1): error: a\n0:5(1): warning: b\n"
    assert source.whole.explain(told) == "e.comp:1: error: a\ne.comp:3: warning: b\n"


# --- what the driver thinks ----------------------------------------------------------------


@pytest.mark.slow_cases("all but *", "only *", "everything*")
@pytest.mark.parametrize("features", FEATURE_SETS)
def test_the_kernel_compiles_without_a_warning(ctx: moderngl.Context, features: str) -> None:
    assert ctx.version_code >= 430
    assert (
        warnings((COMPUTE, Source("trace.comp", FEATURE_SETS[features], texts=WRITTEN).live.text))
        == []
    )


@pytest.mark.slow
def test_the_kernel_with_layers_compiles_without_a_warning(ctx: moderngl.Context) -> None:
    assert ctx.version_code >= 430
    for layers in ({"LAYERS": 6}, {"LAYERS": 3, "BY_LENGTH": True}):
        source = Source("trace.comp", {**EVERYTHING, **layers}, texts=WRITTEN)
        assert imprecise(source.whole.text) == []
        assert warnings((COMPUTE, source.live.text)) == []


@pytest.mark.slow_cases("everything-*")
@pytest.mark.parametrize("render_pass", OF_PIXELS)
@pytest.mark.parametrize("features", ["everything", "nothing"])
def test_aovs_and_surfaces_compile_without_a_warning(
    ctx: moderngl.Context, features: str, render_pass: RenderPass
) -> None:
    constants = FEATURE_SETS[features]
    (compute,) = sources("compute", constants, WRITTEN, render_pass)
    assert imprecise(compute.whole.text) == []
    assert computed_returns(compute.whole.text) == []
    assert warnings((COMPUTE, compute.live.text)) == []
    vertex, fragment = sources("fragment", constants, WRITTEN, render_pass)
    assert warnings((VERTEX, vertex.live.text), (FRAGMENT, fragment.live.text)) == []


@pytest.mark.slow_cases("everything-*")
@pytest.mark.parametrize(
    "render_pass", [PARTICLES, SPLATS, TOLD], ids=["followed", "added", "told"]
)
@pytest.mark.parametrize("features", ["everything", "nothing"])
def test_other_passes_compile_without_a_warning(
    ctx: moderngl.Context, features: str, render_pass: RenderPass
) -> None:
    assert ctx.version_code >= 430
    constants = {**FEATURE_SETS[features], "CASTERS": 5, "LINKED": 5, "TARGETS": 2}
    (compute,) = sources("compute", constants, WRITTEN, render_pass)
    assert imprecise(compute.whole.text) == []
    assert computed_returns(compute.whole.text) == []
    assert warnings((COMPUTE, compute.live.text)) == []


@pytest.mark.slow
def test_a_warning_of_the_driver_is_seen(ctx: moderngl.Context, shaders: Path) -> None:
    number = plant(shaders / "sampling/warp.glsl", "float odd() { float x; return x; }")
    text = (shaders / "integrators/path_state.glsl").read_text()
    use = "return Path(ray, vec3(1.0)"
    assert text.count(use) == 1
    (shaders / "integrators/path_state.glsl").write_text(
        text.replace(use, use.replace("vec3(1.0)", "vec3(odd())"))
    )
    source = Source("trace.comp", EVERYTHING, texts=WRITTEN)
    Kernel(ctx, source).release()
    for _ in ("for the first time", "again, though the driver may have it in its cache"):
        told = [source.live.explain(line) for line in warnings((COMPUTE, source.live.text))]
        assert told
        assert all(
            f"sampling/warp.glsl:{number}:" in line and "initialized" in line for line in told
        )


@pytest.mark.slow
@pytest.mark.parametrize("features", FEATURE_SETS)
def test_the_fragment_kernel_is_glsl_4_10(ctx: moderngl.Context, features: str) -> None:
    vertex, fragment = sources("fragment", FEATURE_SETS[features], WRITTEN)
    FragmentKernel(ctx, vertex, fragment).release()
    assert warnings((VERTEX, vertex.live.text), (FRAGMENT, fragment.live.text)) == []


def test_glsl_4_10_refuses_what_came_later(ctx: moderngl.Context) -> None:
    for late in ("buffer Later { float later[]; };", "layout(binding = 1) uniform L { float l; };"):
        parts = {FILE: WRITTEN[FILE] + late}
        with pytest.raises(RenderError, match="refuses a shader"):
            FragmentKernel(ctx, *sources("fragment", EVERYTHING, parts))


def test_both_kernels_include_the_same_path_tracer() -> None:
    for entry in ("trace.comp", "trace.frag"):
        assert read(entry).count('#include "trace.glsl"') == 1
    assert FILE in INCLUDES
    assert not (folder("shaders_glsl") / FILE).exists()


@pytest.mark.slow
def test_the_kernel_takes_another_hash(ctx: moderngl.Context) -> None:
    texts = {**WRITTEN, "sampling/hash.glsl": read("sampling/other_hash.glsl")}
    source = Source("trace.comp", EVERYTHING, texts=texts)
    assert "0x7FEB352Du" in source.whole.text
    assert "747796405u" not in source.whole.text
    Kernel(ctx, source).release()
