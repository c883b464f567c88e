"""The house keeps its rules: who imports whom, who knows OpenGL, and what path code may say."""

import ast
import re
from itertools import chain
from pathlib import Path
from statistics import median

import pytest

import glrt
from glrt.resources import folder

PACKAGE = Path(glrt.__file__).parent
# A module imports only what stands above it. A package counts as one.
ORDER = [
    *(
        "version",
        "errors",
        "signals",
        "garbage",
        "streams",
        "resources",
        "files",
        "settings",
        "scene_parts",
        "scene",
        "scene_advice",
    ),
    *(
        "scene_file",
        "cautions",
        "needs",
        "layout",
        "shader",
        "relight",
        "omissions",
        "bvh",
        "nodes",
        "lamps",
        "pack",
        "texels",
        "blocks",
        "stats",
        "tonemap",
        "gathered",
        "recipe",
    ),
    *(
        "image",
        "resume",
        "doubt",
        "library",
        "compare_noise",
        "comparison",
        "compare",
        "compare_picture",
    ),
    *("context", "kernel", "probe", "selftest", "pipelines", "film", "mix", "display"),
    *("false_colors", "schedule", "uploaded", "turns", "tracer"),
    *(
        "renderer",
        "__init__",
        "again",
        "job",
        "keeper",
        "progress",
        "examination",
        "remedies",
        "doctor",
        "lab",
        "ui",
        "arguments",
        "compare_command",
        "order",
        "render_command",
        "cli",
    ),
    "__main__",
]
KNOW_OPENGL = {
    "context",
    "kernel",
    "pipelines",
    "probe",
    "selftest",
    "film",
    "mix",
    "display",
    "false_colors",
    "uploaded",
    "renderer",
}
SLOW_TO_IMPORT = {"OpenEXR", "PIL", "matplotlib", "rich"}
MOST_LINES_OF_A_FILE = 300
MOST_LINES_OF_A_FUNCTION = 60

ENTRIES = {
    "trace.comp",
    "trace.vert",
    "trace.frag",
    "blocks.glsl",
    "display.frag",
    "display.vert",
} | {"mix.frag", "false_colors.frag"}
NOT_OF_A_PATH = {*ENTRIES, "tonemap.glsl"}
PATH_LITERALS = {"0.0", "0.5", "1.0", "2.0", "3.0", "4.0", "3.14159265358979324"} | {
    "3.402823466e38",  # the largest float: no distance is beyond it
    "3.814697265625e-6",  # 2^-18: 64 roundings of a float, how much wider boxes are
    "5.9604644775390625e-8",  # 2^-24: an integer of 24 bits to the unit interval
    "65536.0",  # 2^16: the chances of roulette
    "1.1920928955078125e-7",  # 2^-23: the last place of a float from its power of two
    *("0.333323916", "0.19974214", "0.140413272", "0.0996847111"),  # of an arc tangent
    *("0.0602030977", "0.0247340375", "0.00482252624"),
}


def module_of(file: Path) -> str:
    """The name that stands for a file in ORDER."""
    return file.relative_to(PACKAGE).with_suffix("").parts[0]


def sources() -> list[Path]:
    return sorted(PACKAGE.rglob("*.py"))


def imported(tree: ast.AST) -> set[str]:
    """All modules imported anywhere in a tree, in full."""
    names: set[str] = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, "relative imports"
            package = node.module or ""
            names |= {f"glrt.{a.name}" for a in node.names} if package == "glrt" else {package}
    return names


def own_imports(tree: ast.AST) -> set[str]:
    """The modules of glrt that are imported; a name of the package itself is `__init__`."""
    parts = [name.split(".") for name in imported(tree)]
    inner = {part[1] if len(part) > 1 else "__init__" for part in parts if part[0] == "glrt"}
    return {name if name in ORDER else "__init__" for name in inner}


def uses(tree: ast.AST, library: str) -> bool:
    return library in {name.split(".")[0] for name in imported(tree)}


def upward(module: str, tree: ast.AST) -> set[str]:
    """What a module imports though it does not stand above it."""
    place = ORDER.index(module)
    return {name for name in own_imports(tree) - {module} if ORDER.index(name) >= place}


def glsl_files() -> dict[str, str]:
    """Shader files without their comments, line for line."""
    return {path.name: bare(path.read_text()) for path in folder("shaders_glsl").iterdir()}


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


def test_every_module_has_its_place_in_the_order() -> None:
    assert {module_of(file) for file in sources()} <= set(ORDER)
    assert len(ORDER) == len(set(ORDER))


@pytest.mark.parametrize("file", sources(), ids=lambda file: file.stem)
def test_a_module_imports_only_what_stands_above_it(file: Path) -> None:
    assert upward(module_of(file), ast.parse(file.read_text())) == set()


def test_an_import_against_the_order_is_seen_wherever_it_stands() -> None:
    late = ast.parse("def f():\n    from glrt.renderer import Renderer\n    import glrt.kernel\n")
    assert upward("kernel", late) == {"renderer"}
    assert upward("shader", late) == {"renderer", "kernel"}
    assert upward("cli", late) == set()
    assert upward("film", ast.parse("from glrt import renderer, files")) == {"renderer"}
    assert upward("film", ast.parse("import glrt")) == {"__init__"}
    assert upward("film", ast.parse("from glrt import VERSION")) == {"__init__"}


def test_only_a_few_modules_know_opengl() -> None:
    trees = {file: ast.parse(file.read_text()) for file in sources()}
    outside = {"lab", "ui"}  # they drive a renderer, and may look at its textures
    know = {module_of(file) for file, tree in trees.items() if uses(tree, "moderngl")}
    assert know - outside <= KNOW_OPENGL


@pytest.mark.parametrize("file", sources(), ids=lambda file: file.stem)
def test_libraries_that_are_slow_to_import_wait_until_they_are_used(file: Path) -> None:
    tree = ast.parse(file.read_text())
    later = ast.FunctionDef | ast.If  # `if TYPE_CHECKING` is for mypy alone
    top = ast.Module([node for node in tree.body if not isinstance(node, later)], [])
    for node in ast.walk(top):
        if isinstance(node, ast.ClassDef):
            node.body = []
    assert [library for library in SLOW_TO_IMPORT if uses(top, library)] == []


def test_files_are_short() -> None:
    files = [*sources(), *folder("shaders_glsl").iterdir()]
    lengths = {file.name: len(file.read_text().splitlines()) for file in files}
    assert {name: n for name, n in lengths.items() if n > MOST_LINES_OF_A_FILE} == {}


def test_functions_fit_a_screen_and_most_are_shorter_than_ten_lines() -> None:
    python = [python_functions(file) for file in sources()]
    shaders = {name: functions(text) for name, text in glsl_files().items()}
    assert shaders["warp.glsl"]["sample_disk"] == 6
    assert shaders["sampler.glsl"]["make_sampler"] == 3
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


def test_path_code_has_no_tolerances() -> None:
    number = re.compile(r"(?<![\w.])(?:\d+\.\d*|\.\d+|\d+(?=[eE]))(?:[eE][-+]?\d+)?")
    found = {literal for text in path_files().values() for literal in number.findall(text)}
    assert found == PATH_LITERALS
    assert number.findall("t > 1e-4 ? .5 : 1.5e+3 + 2. - v2.x") == ["1e-4", ".5", "1.5e+3", "2."]


def test_path_code_holds_no_preprocessor_switch() -> None:
    for name, text in path_files().items():
        assert re.findall(r"^\s*#", text, re.MULTILINE) == [], name


def test_random_numbers_are_drawn_from_the_sampler_alone() -> None:
    for name, text in path_files().items():
        if name not in ("rng.glsl", "sobol.glsl", "sampler.glsl"):
            assert re.findall(r"pcg_hash|unit_float|\bdimension\b", text) == [], name
            assert set(re.findall(r"next_\dd\(([^)]*)\)", text)) <= {"rng"}, name


def test_a_statement_draws_one_number() -> None:
    for name, text in {**path_files(), "trace.comp": glsl_files()["trace.comp"]}.items():
        for statement in re.split(r"[;{}]", text):
            assert statement.count("next_") <= 1, f"{name}: {statement}"
