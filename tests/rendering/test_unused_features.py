"""A scene that does not use a feature gets the program that it got before the feature existed.

The test compares the driver's program binaries. Without the functions of a feature that the scene
leaves out, the binary is the same to the byte, except hashes of the source and bytes around them.
"""

import ctypes
import re
import uuid
from collections.abc import Callable, Iterable
from typing import Any

import numpy as np
import pytest

from glrt.gpu.context import Context
from glrt.gpu.glsl import Source, read
from glrt.image.sources import load
from glrt.rendering.pipelines import Variant
from glrt.rendering.renderer import Renderer
from tests.support.driver_log import library

_FORMATS, _LENGTH = 0x87FE, 0x8741  # NUM_PROGRAM_BINARY_FORMATS, PROGRAM_BINARY_LENGTH
AROUND = 320  # bytes: next to the hash of the source lies a struct with holes, never written
COMMENTED = "sampling/hash.glsl"  # a file that every kernel has
TRIES = 3  # until a program is as long as another of the same text
TELLING = ("path.glsl", "roulette.glsl")  # files in which a path records what happens
UNDEFINED = 8  # other bytes of a hundred thousand that hold what was in memory before, now and then
RENUMBERED = 100  # bytes: numbers of constants that change places, and three marks as exact

pytestmark = pytest.mark.usefixtures("exact_kernels")

# Scenes, their settings, and the files of functions that they leave out.
UNUSED: list[tuple[str, dict[str, Any], list[str]]] = [
    ("cornell", {}, ["shapes/sphere_tree.glsl", "shapes/coincident.glsl"]),
    ("cornell", {}, ["shapes/disk.glsl", "shapes/box.glsl"]),
    ("cornell", {}, ["shapes/cylinder.glsl"]),
    ("cornell", {}, ["lights/sky.glsl", "film/layers.glsl", "probes/query.glsl"]),
    ("cornell", {"method": "naive"}, ["lights/sampling.glsl"]),
    ("lens", {}, ["bsdfs/dielectric.glsl"]),
    ("weekend", {}, ["bsdfs/dispersion.glsl"]),
    ("lamps", {}, ["bsdfs/ggx.glsl", "bsdfs/metal.glsl", "probes/maps.glsl"]),
    ("lamps", {"sampler": "independent"}, ["sampling/sobol.glsl"]),
    ("metals", {}, ["probes/grid.glsl"]),
    ("gloss", {}, ["bsdfs/iridescence.glsl", "bsdfs/sheen.glsl", "bsdfs/crossing_base.glsl"]),
    ("metals", {"method": "blinn"}, ["integrators/phong.glsl"]),
    ("methods/open", {}, ["lights/quad_solid_angle.glsl"]),
    (
        "weekend",
        {},
        [
            *("shapes/tree_node.glsl", "shapes/tree_stack.glsl", "shapes/tree.glsl"),
            *("shapes/quad.glsl", "lights/choice.glsl", "shapes/coincident.glsl"),
        ],
    ),
]


def emptied(glsl: str) -> str:
    """A file whose functions return nothing in particular."""
    head = r"^(\w+) (\w+\([^;{}]*\))\s*(?:\{[^\n]*\}$|\{.*?^\})"
    text = re.sub(r"[ ]*//[^\n]*", "", glsl)

    def stub(match: re.Match[str]) -> str:
        kind, rest = match[1], match[2]
        body = "" if kind == "void" else f"{kind} nothing; return nothing; "
        return f"{kind} {rest} {{ {body}}}"

    return re.sub(head, stub, text, flags=re.MULTILINE | re.DOTALL)


def program_of(context: Context, scene: str, texts: dict[str, str], **settings: Any) -> Any:
    """The driver's program of a kernel with these files, (n,) uint8.

    A new comment forces a compilation: a program out of the driver's cache may be a few bytes
    shorter.
    """
    size: dict[str, Any] = {"width": 32, "height": 32}
    unseen = f"{read(COMMENTED)}// {uuid.uuid4()}\n"
    variant = Variant(texts={COMMENTED: unseen, **texts})
    renderer = Renderer(
        load(scene), context=context, tier="complete", variant=variant, **size, **settings
    )
    gl, length, kind = library(), ctypes.c_int(), ctypes.c_uint()
    with context.gl:
        number = renderer._tracer.switch.kernel._program.glo
        gl.glGetProgramiv(number, _LENGTH, ctypes.byref(length))
        data = ctypes.create_string_buffer(length.value)
        gl.glGetProgramBinary(number, length, None, ctypes.byref(kind), data)
    renderer.release()
    return np.frombuffer(data.raw, np.uint8)


@pytest.fixture(autouse=True)
def binaries(context: Context) -> None:
    """A driver that gives its programs out."""
    count = ctypes.c_int()
    with context.gl:
        library().glGetIntegerv(_FORMATS, ctypes.byref(count))
    if not context.is_software or not count.value:
        pytest.skip("this driver gives out no programs, or none that could be compared")


def equally_long(program: Callable[[], Any], count: int) -> list[Any]:
    """So many programs of one length: of equal texts, one in some is a word longer or shorter."""
    by_length: dict[int, list[Any]] = {}
    for _ in range(TRIES * count):
        found = program()
        alike = by_length.setdefault(len(found), [])
        alike.append(found)
        if len(alike) == count:
            return alike
    raise AssertionError(f"lengths are {sorted(by_length)}")


def differing(programs: Iterable[Any]) -> Any:
    """Where programs of one length differ, and AROUND: bytes near a hash may be undefined."""
    first, *others = programs
    known = np.zeros(len(first), bool)
    for place in np.flatnonzero(np.any([first != other for other in others], axis=0)):
        known[max(place - AROUND, 0) : place + AROUND] = True
    return known


def unreported(glsl: str) -> str:
    """A file without the calls by which a path records what happens."""
    return re.sub(r"^ *record_\w+\([^;]*\);\n", "", glsl, flags=re.MULTILINE)


@pytest.mark.slow
@pytest.mark.parametrize(("scene", "settings", "files"), UNUSED)
def test_functions_that_a_scene_leaves_out_change_no_byte(
    context: Context, scene: str, settings: dict[str, Any], files: list[str]
) -> None:
    texts = {file: emptied(read(file)) for file in files}
    assert_same_program(context, scene, texts, **settings)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("scene", "method"),
    [("cornell", "naive"), ("lamps", "nee"), ("metals", "mis"), ("sky", "mis"), ("weekend", "mis")],
)
def test_what_a_path_reports_changes_no_byte(context: Context, scene: str, method: str) -> None:
    texts = {name: unreported(read(f"integrators/{name}")) for name in TELLING}
    assert all("record_" not in text for text in texts.values())
    texts = {f"integrators/{name}": text for name, text in texts.items()}
    assert_same_program(context, scene, texts, method=method)


def assert_same_program(
    context: Context, scene: str, texts: dict[str, str], **settings: Any
) -> None:
    """The driver makes the same of a kernel with these files as without."""
    assert_same(
        lambda: program_of(context, scene, {}, **settings),
        lambda: program_of(context, scene, texts, **settings),
    )


def assert_same(
    program: Callable[[], Any], other: Callable[[], Any], allowed: int = UNDEFINED
) -> None:
    """Two programs are as long and the same, except some bytes and those around hashes."""
    plain, *others = equally_long(program, 4)
    compiled = (other() for _ in range(TRIES))
    found = next((each for each in compiled if len(each) == len(plain)), None)
    assert found is not None, "all are longer or shorter"
    hashes = differing([plain, *others])
    assert hashes.mean() < 0.03
    beyond = np.flatnonzero((found != plain) & ~hashes)
    assert len(beyond) <= allowed, beyond


@pytest.mark.slow
@pytest.mark.parametrize(
    "scene",
    ["cornell", "lamps", "lens", "metals", "gloss", "sky", "smoke", "spot", "weekend"],
)
def test_code_that_is_left_out_changes_numbers_of_constants_alone(
    context: Context, monkeypatch: pytest.MonkeyPatch, scene: str
) -> None:
    def of_all_lines() -> Any:
        with monkeypatch.context() as patch:
            patch.setattr(Source, "live", Source.whole)
            return program_of(context, scene, {})

    assert_same(lambda: program_of(context, scene, {}), of_all_lines, RENUMBERED)


@pytest.mark.slow
def test_functions_that_a_scene_uses_do(context: Context) -> None:
    plain = program_of(context, "lamps", {})
    for file in ("bsdfs/matte.glsl", "lights/sampling.glsl"):
        other = program_of(context, "lamps", {file: emptied(read(file))})
        assert len(other) != len(plain) or np.sum(other != plain) > 1000, file


def test_a_file_is_emptied_of_code_alone() -> None:
    head = "const int A = 1;\nstruct S { int a; };\n"
    text = f"{head}int f(int x) {{\n    return x;  // y\n}}\nS g() {{ return S(1); }}\n"
    assert emptied(text) == (
        f"{head}int f(int x) {{ int nothing; return nothing; }}\n"
        "S g() { S nothing; return nothing; }\n"
    )
