"""Code that can run: what is left out, and that the rest does the same."""

import random

import moderngl
import numpy as np
import pytest

from glrt.gpu.context import Context
from glrt.gpu.glsl import Source, files_reread, shader_files
from glrt.gpu.live_code import _Shader, live_lines
from glrt.image.sources import load
from glrt.rendering.renderer import Renderer
from glrt.settings import settings_for
from tests.support.builders import FEATURE_SETS
from tests.support.kernel_text import written_for

HEAD = """const bool YES = true;
const bool NO = false;
const int COUNT = 2;
const bool BOTH = YES && COUNT > 1;
bool asked(int x) { return NO || COUNT == 0; }
bool told(int x) { return x > 0; }
float f(float x) { return x; }
float g(float x) { return 2.0 * x; }
bool moves(inout int x) { x += 1; return true; }"""
NAMES = ("asked", "told", "f", "g", "moves")


def live(body: str) -> str:
    """The live lines of an entry with a body, and the functions that it reaches, in one line."""
    lines = [*HEAD.splitlines(), "void main() {", *body.splitlines(), "}"]
    found = [text for _, text in live_lines(lines)]
    start = found.index("void main() {")
    reached = [name for name in NAMES if any(f" {name}(" in text for text in found[:start])]
    return " ".join((*(" ".join(found[start + 1 : -1]).split()), "|", *reached))


@pytest.mark.parametrize(
    ("body", "left"),
    [
        ("if (NO) f(x);\ng(x);", "g(x); | g"),
        ("if (!YES) { f(x); } else g(x);", "g(x); | g"),
        ("if (YES) f(x); else g(x);", "f(x); | f"),
        ("if (BOTH) f(x); else if (NO) g(x);", "f(x); | f"),
        ("if (told(x)) if (YES) f(x); else g(x); else g(x);",
         "if (told(x)) f(x); else g(x); | told f g"),
        ("if (told(x)) if (NO) f(x); else if (b) g(x); else f(x); else g(x);",
         "if (told(x)) if (b) g(x); else f(x); else g(x); | told f g"),
        ("if (told(x)) f(x); else if (NO) g(x);", "if (told(x)) f(x); else ; | told f"),
        ("for (int i = 0; i < 3; i += 1) if (NO) f(x);", "for (int i = 0; i < 3; i += 1) ; |"),
        ("if (COUNT != 2 || asked(3)) f(x);", "|"),
        ("if (x > 0.0 && NO) f(x);", "|"),
        ("if (moves(i) && NO) f(x);", "if (moves(i) && NO) f(x); | f moves"),
        ("if (moves(i) && NO && told(i)) f(x);", "if (moves(i) && NO) f(x); | f moves"),
        ("b = told(i) || YES || asked(i);", "b = told(i) || YES; | told"),
        ("b = (NO || COUNT < 2) && told(i);", "b = (NO || COUNT < 2); |"),
        ("x = NO ? f(x) : g(x);", "x = g(x); | g"),
        ("x = 3.0 * (YES ? f(x) : g(x)) + 1.0;", "x = 3.0 * (f(x)) + 1.0; | f"),
        ("x = YES ? x < 1e-5 ? f(x) : 0.0 : g(x);", "x = x < 1e-5 ? f(x) : 0.0; | f"),
        ("if (!NO) return;\nf(x);", "return; |"),
        ("if (told(i)) return;\nf(x);", "if (told(i)) return; f(x); | told f"),
        ("if (told(i)) { return; } else { if (YES) return; }\nf(x);",
         "if (told(i)) { return; } else { return; } | told"),
        ("if (told(i)) return; else x = 1.0;\nf(x);",
         "if (told(i)) return; else x = 1.0; f(x); | told f"),
        ("while (told(i)) { if (YES) break; f(x); }\ng(x);",
         "while (told(i)) { break; } g(x); | told g"),
        ("// f(x) if (NO)\ng(x);", "// f(x) if (NO) g(x); | g"),
        ("a[i++] = vec3[2](vec3(f(x)), v).x;", "a[i++] = vec3[2](vec3(f(x)), v).x; | f"),
    ],
)  # fmt: skip
def test_only_what_can_run_is_left(body: str, left: str) -> None:
    assert live(body) == left


@pytest.mark.parametrize("body", ["if (NO) f(x", "switch (i) { case 1: if (NO) f(x); }", "= ?;"])
def test_text_that_is_not_understood_stays(body: str) -> None:
    lines = [*HEAD.splitlines(), "void main() {", f"if (NO) f(x); {body}", "}"]
    assert live_lines(lines) == [*enumerate(lines)]


def test_shaders_without_an_entry_stay() -> None:
    lines = HEAD.splitlines()
    assert live_lines(lines) == [*enumerate(lines)]


def test_all_functions_of_a_name_and_those_of_declarations_are_reached() -> None:
    lines = [
        "float twice(float x) { return h(x); }",
        "float twice(int x) { return k(x); }",
        "float h(float x) { return x; }",
        "float k(int x) { return 1.0; }",
        "float never(float x) { return x; }",
        "float of_table(int i) {",
        "    return 1.0;",
        "}",
        "const float TABLE[1] = float[1](of_table(0));",
        "void main() { twice(1); }",
    ]
    wanted = [(place, text) for place, text in enumerate(lines) if "never" not in text]
    assert live_lines(lines) == wanted


def test_messages_of_the_driver_lead_to_the_lines_of_the_whole() -> None:
    text = "float f() {\n    return 1.0;\n}\nvoid main() {\n    if (A) { f(); }\n    x = 1;\n}"
    source = Source("e.comp", {"A": False}, texts={"e.comp": text})
    assert source.live.text.count("\n") < source.whole.text.count("\n")
    number = source.live.text.split("\n").index("    x = 1;") + 1
    assert source.live.explain(f"0:{number}(5): error") == "e.comp:6: error"


# --- the same results ----------------------------------------------------------------------

FUNCTIONS = 60


def expression(numbers: random.Random, depth: int) -> str:
    """A random condition, of constants, inputs and calls that count themselves."""
    if depth == 0 or numbers.random() < 0.3:
        return numbers.choice(
            [
                "A",
                "B",
                "!A",
                "COUNT > 1",
                "COUNT == 0",
                "i > 3",
                "x < 2.0",
                "counts(i)",
                "steady(i)",
            ]
        )
    parts = [expression(numbers, depth - 1) for _ in range(3)]
    return numbers.choice(
        [
            "({0} && {1})", "({0} || {1})", "!({0})", "({0} ? {1} : {2})",
            "({0} && {1} && {2})", "({0} || {1} && {2})",
        ]
    ).format(*parts)  # fmt: skip


def statement(numbers: random.Random, depth: int) -> str:
    """A random statement that changes `x` or `i`, or returns."""
    if depth == 0 or numbers.random() < 0.25:
        return numbers.choice(["x += 1.0;", "i += 1;", "x *= A ? 3.0 : 5.0;", "return x + 7.0;"])
    condition, parts = expression(numbers, 2), [statement(numbers, depth - 1) for _ in range(3)]
    return numbers.choice(
        [
            "if ({c}) {0}", "if ({c}) {0} else {1}", "if ({c}) {{ {0} {1} }} else {2}",
            "for (int k = 0; k < 2; k += 1) {{ if ({c}) break; {0} }}", "{{ {0} {1} {2} }}",
        ]
    ).format(*parts, c=condition)  # fmt: skip


@pytest.mark.slow_cases("0", "2", "3")
@pytest.mark.parametrize("seed", range(4))
def test_random_functions_do_the_same(ctx: moderngl.Context, seed: int) -> None:
    numbers = random.Random(seed)
    names, text = [], "int counted = 0;\n"
    text += "bool counts(int i) {\n    counted += 1;\n    return (i & 1) == 0;\n}\n"
    text += "bool steady(int i) {\n    if (B) return A;\n    return COUNT == 2;\n}\n"
    for number in range(FUNCTIONS):
        body = "\n    ".join(statement(numbers, 3) for _ in range(4))
        text += f"float f{number}(float x, int i) {{\n    {body}\n    return x + float(i);\n}}\n"
        names.append(f"f{number}(float(at), int(at))")
    calls = "\n".join(f"    found[{FUNCTIONS}u * at + {n}u] = {c};" for n, c in enumerate(names))
    text += "layout(local_size_x = 8) in;\nlayout(std430) buffer Found { float found[]; };\n"
    text += f"void main() {{\n    uint at = gl_LocalInvocationID.x;\n{calls}\n"
    text += f"    found[{FUNCTIONS * 8}u + at] = float(counted);\n}}\n"
    constants: dict[str, bool | int] = {"A": bool(seed & 1), "B": bool(seed & 2), "COUNT": seed}
    source = Source("e.comp", constants, texts={"e.comp": text})
    assert len(source.live.text) < 0.7 * len(source.whole.text)
    found = []
    for code in (source.whole, source.live):
        program = ctx.compute_shader(code.text)
        buffer = ctx.buffer(reserve=4 * 8 * (FUNCTIONS + 1))
        buffer.bind_to_storage_buffer(0)
        program.run(1)
        found.append(np.frombuffer(buffer.read(), np.float32))
        program.release()
        buffer.release()
    np.testing.assert_array_equal(found[0], found[1])
    assert len(set(found[0].tolist())) > FUNCTIONS / 4


def test_each_shader_is_understood() -> None:
    entries = [path.name for path in shader_files() if path.suffix in (".comp", ".frag", ".vert")]
    assert len(entries) > 30
    for entry in entries:
        source = Source(entry, FEATURE_SETS["nothing"], texts=written_for())
        assert list(_Shader([line.text for line in source.whole.lines]).live())


def test_a_kernel_without_features_is_half_as_long() -> None:
    source = Source("trace.comp", FEATURE_SETS["nothing"], texts=written_for())
    assert len(source.live.text) < 0.5 * len(source.whole.text)


@pytest.mark.slow
@pytest.mark.usefixtures("exact_kernels")
@pytest.mark.parametrize("name", ["cornell", "metals", "spot", "lens", "sky", "drink", "smoke"])
def test_pictures_have_the_same_bits(
    context: Context, name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    scene = load(name)
    settings = settings_for(scene.render, samples=4, width=48, height=32)
    pictures = []
    for is_whole in (False, True):
        if is_whole:
            monkeypatch.setattr(Source, "live", property(lambda source: source.whole))
        fresh = Context(context.gl, context.route, context.device)  # knows no program
        renderer = Renderer(scene, settings, fresh, "complete")
        pictures.append(renderer.render().image().radiance)
        renderer.release()
    assert pictures[0].any()
    np.testing.assert_array_equal(pictures[0], pictures[1])


def test_an_author_of_shaders_gets_all_lines_of_files_that_are_read_again() -> None:
    text = "int unused() {\n    return 1;\n}\nvoid main() {\n}"
    source = Source("a.comp", texts={"a.comp": text})
    assert "unused" not in source.live.text
    with files_reread():
        assert source.live == source.whole
    assert "unused" not in source.live.text
