"""The house keeps its rules: who imports whom, who knows OpenGL, and what path code may say."""

import ast
import re
from collections import Counter
from itertools import chain
from pathlib import Path
from statistics import median

import glrt
from glrt.core.resources import folder
from glrt.gpu.glsl import shader_files

PACKAGE = Path(glrt.__file__).parent
ROOT = PACKAGE.parent
# Packages whose modules may use moderngl; the others go through them.
KNOW_OPENGL = {"gpu", "packing", "rendering", "view", "analysis"}
SLOW_TO_IMPORT = {"OpenEXR", "PIL", "matplotlib", "rich", "trimesh"}
MOST_MODULES_OF_A_FOLDER = 25
MOST_LINES_OF_A_FILE = 300
MOST_LINES_OF_A_FUNCTION = 60

ENTRIES = {
    "trace.comp",
    "trace.vert",
    "trace.frag",
    "display.frag",
    "display.vert",
    "aov.comp",
    "aov.frag",
    "terms.comp",
    "terms.frag",
    "particles.comp",
    "splats.comp",
    "paths.comp",
} | {"weighting.frag", "false_colors.frag", "aov_view.frag", "first_surface.frag", "magnify.frag"}
ENTRIES |= {"surfaces.comp", "surfaces.frag", "edges.frag", "reproject.frag", "fade.frag"} | {
    *("evidence.frag", "taa.frag", "ataa_mask.frag", "ataa.frag", "gather.comp", "more.comp"),
    "adaptive.comp",
    *(f"probe_{name}.comp" for name in ("rays", "light", "distances", "place")),
    *("probe_balls.vert", "probe_balls.frag"),
    *("silhouette.vert", "silhouette.frag", "silhouette_line.frag", "raster.vert", "raster.frag"),
    *("deformed.vert", "deformed.frag"),
    *("bring_models.frag", "reconstruct.frag", "predict.frag", "predictions.frag"),
    "upsample.frag",
}
NOT_OF_A_PATH = {
    *ENTRIES,
    "passes/tonemap.glsl",
    "trace.glsl",
    "aov.glsl",
    "structs/scene.glsl",
} | {"shapes/all_shapes.glsl", "surfaces.glsl", "passes/reprojection.glsl"}
NOT_OF_A_PATH |= {"passes/probe_balls.glsl", "raster.glsl"}
NOT_OF_A_PATH |= {
    f"temporal/{name}.glsl"
    for name in ("least_squares", "wrls", "wrls_rows", "taa", "ataa", "upsample")
}


def sources() -> list[Path]:
    return sorted(PACKAGE.rglob("*.py"))


def dotted(file: Path) -> str:
    """`glrt.scene.scenefile.toml`; a package has the name of its folder."""
    parts = file.relative_to(ROOT).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


MODULES = {dotted(file): file for file in sources()}


def listed(package: str) -> list[str]:
    """The modules and packages of a package, in the order that its docstring gives them."""
    text = ast.get_docstring(ast.parse(MODULES[package].read_text())) or ""
    return re.findall(r"^- (\w+): ", text, re.MULTILINE)


def children(package: str) -> set[str]:
    """The modules and packages directly below a package."""
    below = (name.removeprefix(f"{package}.") for name in MODULES if name.startswith(f"{package}."))
    return {name for name in below if "." not in name}


def imported(tree: ast.AST) -> set[str]:
    """All modules imported anywhere in a tree, in full; a public name is in `glrt.__init__`."""
    names: set[str] = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, "relative imports"
            module = node.module or ""
            whole = {f"{module}.{alias.name}" for alias in node.names}
            names |= {name if name in MODULES else module for name in whole}
    return names


def upward(importer: str, tree: ast.AST) -> set[str]:
    """Modules imported by a module that does not stand above them.

    Two modules are compared where their paths part: by the order of the package they share.
    """
    found = set()
    for name in imported(tree):
        if name.split(".")[0] != "glrt" or name == importer:
            continue
        here, there = importer.split("."), name.split(".")
        depth = next(
            (i for i, (a, b) in enumerate(zip(here, there, strict=False)) if a != b),
            min(len(here), len(there)),
        )
        if depth == len(there):  # a package around the importer: its names come from below
            found.add(name)
            continue
        order = listed(".".join(here[:depth]))
        if order.index(there[depth]) >= order.index(here[depth]):
            found.add(name)
    return found


def uses(tree: ast.AST, library: str) -> bool:
    return library in {name.split(".")[0] for name in imported(tree)}


def glsl_files() -> dict[str, str]:
    """Shader files without their comments, line for line."""
    root = folder("shaders_glsl")
    return {str(path.relative_to(root)): bare(path.read_text()) for path in shader_files()}


def path_files() -> dict[str, str]:
    """The files whose functions trace a path."""
    return {name: text for name, text in glsl_files().items() if name not in NOT_OF_A_PATH}


def bare(glsl: str) -> str:
    def blank(comment: re.Match[str]) -> str:
        return "\n" * comment[0].count("\n")

    return re.sub(r"//[^\n]*|/\*.*?\*/", blank, glsl, flags=re.DOTALL)


def functions(glsl: str) -> dict[str, int]:
    """The number of lines of each function."""
    whole = r"^\w+ (\w+)\([^;{]*\{(?:[^\n]*\}$|.*?^\})"
    found = re.finditer(whole, glsl, re.MULTILINE | re.DOTALL)
    return {match[1]: match[0].count("\n") + 1 for match in found}


def python_functions(file: Path) -> dict[str, int]:
    """The number of lines of each function."""
    nodes = ast.walk(ast.parse(file.read_text()))
    found = [node for node in nodes if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef)]
    return {node.name: (node.end_lineno or 0) - node.lineno + 1 for node in found}


# --- Python --------------------------------------------------------------------------------


def test_every_package_lists_its_modules() -> None:
    for package in [name for name, file in MODULES.items() if file.stem == "__init__"]:
        assert sorted(listed(package)) == sorted(children(package)), package


def test_a_module_imports_only_what_stands_above_it() -> None:
    trees = {name: ast.parse(file.read_text()) for name, file in MODULES.items() if name != "glrt"}
    found = {name: upward(name, tree) for name, tree in trees.items()}
    assert {name: wrong for name, wrong in found.items() if wrong} == {}


def test_an_import_against_the_order_is_seen_wherever_it_stands() -> None:
    late = ast.parse("def f():\n    from glrt.rendering.renderer import Renderer\n")
    assert upward("glrt.gpu.program", late) == {"glrt.rendering.renderer"}
    assert upward("glrt.rendering.film", late) == {"glrt.rendering.renderer"}
    assert upward("glrt.cli.render", late) == set()
    assert upward("glrt.gpu.glsl", ast.parse("from glrt import settings, api")) == {"glrt.api"}
    assert upward("glrt.rendering.film", ast.parse("import glrt")) == {"glrt"}
    assert upward("glrt.rendering.film", ast.parse("from glrt import Scene")) == {"glrt"}
    inner = ast.parse("from glrt.view.tabs import panel")
    assert upward("glrt.view.state.session", inner) == {"glrt.view.tabs.panel"}
    assert upward("glrt.view.window", inner) == set()


def test_the_product_imports_no_test_and_no_benchmark() -> None:
    trees = {name: ast.parse(file.read_text()) for name, file in MODULES.items()}
    assert [
        name for name, tree in trees.items() if uses(tree, "tests") or uses(tree, "bench")
    ] == []


def test_only_a_few_packages_know_opengl() -> None:
    trees = {name: ast.parse(file.read_text()) for name, file in MODULES.items()}
    know = {name.split(".")[1] for name, tree in trees.items() if uses(tree, "moderngl")}
    assert know <= KNOW_OPENGL


def test_libraries_that_are_slow_to_import_wait_until_they_are_used() -> None:
    later = ast.FunctionDef | ast.If  # `if TYPE_CHECKING` is for mypy alone
    for name, file in MODULES.items():
        top = ast.Module(
            [n for n in ast.parse(file.read_text()).body if not isinstance(n, later)], []
        )
        for node in ast.walk(top):
            if isinstance(node, ast.ClassDef):
                node.body = []
        assert [library for library in SLOW_TO_IMPORT if uses(top, library)] == [], name


def test_files_are_short() -> None:
    outside = [file for name in ("bench", "tests", "tools") for file in (ROOT / name).rglob("*.py")]
    lengths = {
        str(f): len(f.read_text().splitlines()) for f in [*sources(), *outside, *shader_files()]
    }
    assert {name: n for name, n in lengths.items() if n > MOST_LINES_OF_A_FILE} == {}


def test_folders_hold_few_modules() -> None:
    counts = Counter(file.parent for file in sources() if file.name != "__init__.py")
    assert {str(f): n for f, n in counts.items() if n > MOST_MODULES_OF_A_FOLDER} == {}


def test_functions_fit_a_screen_and_most_are_shorter_than_ten_lines() -> None:
    python = [python_functions(file) for file in sources()]
    shaders = {name: functions(text) for name, text in glsl_files().items()}
    assert shaders["sampling/warp.glsl"]["sample_disk"] == 6
    assert shaders["sampling/sampler.glsl"]["make_sampler"] == 3
    lengths = [found.values() for found in (*python, *shaders.values())]
    assert max(chain.from_iterable(lengths)) <= MOST_LINES_OF_A_FUNCTION
    assert median(chain.from_iterable(lengths)) < 10


# --- GLSL ----------------------------------------------------------------------------------


def test_only_entry_files_know_where_data_lies() -> None:
    word = re.compile(r"\b(binding|buffer|image2D|layout|uniform|gl_\w+|#version)\b")
    for name, text in glsl_files().items():
        if name not in ENTRIES:
            assert word.findall(text) == [], name


def test_no_shader_fixes_a_binding() -> None:
    assert not [name for name, text in glsl_files().items() if "binding" in text]


def test_path_code_leaves_alone_functions_that_differ_between_drivers() -> None:
    word = re.compile(
        r"\b(pow|exp\w*|log\w*|acos|asin|atan|tan|mix|refract|reflect|normalize|inversesqrt"
        r"|faceforward|smoothstep|isnan|isinf|fma)\s*\("
    )
    for name, text in {**path_files(), "trace.comp": glsl_files()["trace.comp"]}.items():
        assert word.findall(text) == [], name


def tolerances(glsl: str) -> list[str]:
    """Comparisons with small numbers that have no name: a name says what the number is for."""
    number = r"(?<![\w.])((?:\d+\.\d*|\.\d+|\d+(?=[eE]))(?:[eE][-+]?\d+)?)"
    found = re.findall(rf"(?:[<>]=?|[=!]=) *-?{number}|{number} *(?:[<>]=?|[=!]=)", glsl)
    return [literal for pair in found for literal in pair if literal and 0 < float(literal) < 0.01]


def test_path_code_has_no_tolerances() -> None:
    assert {name: tolerances(text) for name, text in path_files().items() if tolerances(text)} == {}
    assert tolerances("t > 1e-4 ? .5 : 0.0 < x && 1.e-3 >= y && z != -.001") == [
        *("1e-4", "1.e-3", ".001"),
    ]


def test_path_code_holds_no_preprocessor_switch() -> None:
    for name, text in path_files().items():
        assert re.findall(r"^\s*#", text, re.MULTILINE) == [], name


def test_random_numbers_are_drawn_from_the_sampler_alone() -> None:
    for name, text in path_files().items():
        if name.split("/")[0] != "sampling":
            assert re.findall(r"pcg_hash|unit_float|\bdimension\b", text) == [], name
            assert set(re.findall(r"next_\dd\(([^)]*)\)", text)) <= {"rng"}, name


def test_a_statement_draws_one_number() -> None:
    for name, text in {**path_files(), "trace.comp": glsl_files()["trace.comp"]}.items():
        for statement in re.split(r"[;{}]", text):
            assert statement.count("next_") <= 1, f"{name}: {statement}"
