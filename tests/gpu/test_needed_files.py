"""Which shader files an expression needs."""

from glrt.gpu.evaluate import needed_files, path_files
from glrt.gpu.glsl import read

FILES = {
    "blocks": "layout(std430) readonly buffer Rows { float rows[]; };\n",
    "size": "const float SIZE = 2.0;\n// of what is_far names\n",
    "thing": "struct Thing {\n    float size;\n};\n",
    "near": "bool is_near(Thing thing) { return thing.size < SIZE; }\n",
    "far": "precise bool is_far(Thing thing) {\n    return !is_near(thing);\n}\n",
    "other": "vec3 colors[2];\nfloat is_far_too(float x) { return x; }\n",
}


def test_files_are_needed_by_way_of_others() -> None:
    assert needed_files("is_far(Thing(1.0))", FILES) == ["blocks", "size", "thing", "near", "far"]
    assert needed_files("Thing(1.0).size", FILES) == ["blocks", "thing"]
    assert needed_files("colors[0]", FILES) == ["blocks", "other"]
    assert needed_files("1.0", FILES) == ["blocks"]


def test_few_files_are_needed_for_a_formula_and_most_for_a_path() -> None:
    files = {name: read(name) for name in path_files() if not name.startswith("scene_arrays")}
    formula, path = needed_files("fresnel(c, eta)", files), needed_files("add_samples", files)
    assert "bsdfs/dielectric.glsl" in formula
    assert len(formula) < 8
    assert len(path) > len(files) / 2
