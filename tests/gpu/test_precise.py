"""Every float that the kernel assigns or returns is `precise`, and the search for others works."""

import re

import pytest

from glrt.gpu.glsl import Source, read, shader_files, with_precise_floats
from glrt.rendering.pipelines import Tier
from tests.support.builders import EVERYTHING
from tests.support.kernel_text import written_for


def function_bodies(glsl: str) -> list[str]:
    """The text between the braces of each function."""
    text = re.sub(r"//[^\n]*|/\*.*?\*/", "", glsl, flags=re.DOTALL)
    bodies = []
    for start in re.finditer(r"^\w+ \w+\([^;{}]*\)\s*\{", text, re.MULTILINE):
        depth, end = 1, start.end()
        while depth:
            depth += {"{": 1, "}": -1}.get(text[end], 0)
            end += 1
        bodies.append(text[start.end() : end])
    return bodies


def imprecise(glsl: str) -> list[str]:
    """Names of locals and inout parameters that hold floats, declared without `precise`."""
    types = ["float", r"d?vec\d", r"d?mat\d(?:x\d)?", *re.findall(r"\bstruct\s+(\w+)", glsl)]
    local = re.compile(rf"(?<!precise )\b(?:{'|'.join(types)})(?:\s*\[\w*\])?\s+(\w+)\s*[=;,\[)]")
    parameter = re.compile(rf"(?<!precise )\b(?:in)?out\s+(?:{'|'.join(types)})\s+(\w+)")
    found = [name for body in function_bodies(glsl) for name in local.findall(body)]
    return found + parameter.findall(glsl)


def computed_returns(glsl: str) -> list[str]:
    """Sums or products that functions of floats return: they are no precise variables."""
    head = r"^(?:float|vec\d|mat\d) \w+\([^;{}]*\)\s*(\{[^\n]*\}$|\{.*?^\})"
    text = re.sub(r"[ ]*//[^\n]*", "", glsl)
    bodies = [match[1] for match in re.finditer(head, text, re.MULTILINE | re.DOTALL)]
    values = [value for body in bodies for value in re.findall(r"return ([^;]+);", body)]
    return [value for value in values if re.search(r"[\w)\]] [-+*/] [-\w(]", value)]


def test_the_loader_qualifies_floats_and_nothing_else() -> None:
    given = """
struct Ray { vec3 origin; };
struct Turn {
    float angle;
};
layout(std430) buffer Rays {
    vec3 starts[];
};
Ray met = Ray(vec3(0.0));
const float SCALE = 2.0;
float turned(vec3 first, inout float angle, inout int count,
        inout Ray ray) {
    float half_angle;
    int i = 0;
    for (float t = 0.0; t < 1.0; t += 0.5) i += 1;
    // Ray names; float x = 1;
    vec3[2] both = vec3[2](first, first);
    mat3x4 m = mat3x4(1.0);
    return half_angle;
}
vec3 after;
"""
    wanted = given
    for declared in ("float half_angle", "float t =", "vec3[2] both", "mat3x4 m", "Ray met"):
        wanted = wanted.replace(declared, f"precise {declared}")
    for changed in ("inout float angle", "inout Ray ray"):
        wanted = wanted.replace(changed, f"precise {changed}")
    assert with_precise_floats(given) == wanted
    assert with_precise_floats(wanted) == wanted


def test_no_shader_file_says_precise_itself() -> None:
    assert not [str(file) for file in shader_files() if "precise " in read(str(file))]


@pytest.mark.parametrize("way", [("generic", 1 << 16), ("generic", 0), ("complete", 1 << 16)])
def test_every_float_that_the_kernel_assigns_is_precise(way: tuple[Tier, int]) -> None:
    text = Source("trace.comp", EVERYTHING, texts=written_for("cornell", *way)).whole.text
    bodies = function_bodies(text)
    returns = re.sub(r"//[^\n]*", "", text).count("return")
    assert returns == sum(body.count("return") for body in bodies)  # none is missed
    assert text.count("precise ") > 80
    assert imprecise(text) == []
    assert computed_returns(text) == []


def test_a_returned_product_is_found() -> None:
    assert computed_returns("float f(float x) {\n    return x * x;\n}\n") == ["x * x"]
    assert computed_returns("float f(float x) { return x - 1.0; }\n") == ["x - 1.0"]
    assert computed_returns("float f(float x) {\n    return g(x);\n}\n") == []


def test_the_search_for_what_is_not_precise_finds_every_way_to_declare_it() -> None:
    glsl = """
    struct Ray { vec3 origin; };
vec3 field;
Ray f(vec3 parameter, inout float other) {
    vec3 a;  // vec3 comment = 1;
    float b = 1.0, more;
    const float c = 2.0;
    if (b > 0.0) vec3 d = vec3(b);
    for (float e = 0.0; e < 1.0; e += 0.1) { mat3 g = mat3(1.0); }
    float[2] h = float[2](1.0, 2.0);
    vec2 k[3];
    Ray l = Ray(vec3(1.0));
    int i = 0;
    precise float fine = 1.0;
    precise Ray good = Ray(vec3(1.0));
    return Ray(vec3(1.0));
}
"""
    assert imprecise(glsl) == ["a", "b", "c", "d", "e", "g", "h", "k", "l", "other"]
