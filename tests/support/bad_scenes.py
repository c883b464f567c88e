"""Malformed scene files, each with what its message must say: one table for all tests."""

from typing import NamedTuple

GOOD_SCENE = """\
title = "A matte and a glass ball in a box"
format = 1

[camera]
position = [0.0, 0.0, 2.9]
look_at = [0.0, 0.0, 0.0]
up = [0.0, 1.0, 0.0]
fov = 45.0
focus_distance = 2.9
defocus_angle = 0.0

[render]
width = 512
height = 512
samples = 256
bounces = 10
method = "mis"

[background]
color = [0.0, 0.0, 0.0]

[materials.white]
type = "lambertian"
color = [0.75, 0.75, 0.75]

[materials.steel]
type = "metal"
color = [0.9, 0.9, 0.9]
roughness = 0.0

[materials.glass]
type = "dielectric"
ior = 1.5

[materials.lamp]
type = "light"
emission = [8.0, 8.0, 8.0]
color = [0.0, 0.0, 0.0]
group = "ceiling"

[lights]
ceiling = 1.0

[[objects]]
name = "left ball"
shape = "sphere"
center = [-0.4, -0.65, -0.3]
radius = 0.35
material = "white"

[[objects]]
shape = "plane"
point = [0.0, -1.0, 0.0]
normal = [0.0, 1.0, 0.0]
material = "steel"

[[objects]]
shape = "quad"
corner = [-0.4, 0.999, -0.4]
edge_u = [0.8, 0.0, 0.0]
edge_v = [0.0, 0.0, 0.8]
material = "lamp"
"""


class BadScene(NamedTuple):
    """A file that must be refused, and words that the message must contain."""

    name: str
    content: str | bytes
    says: tuple[str, ...]


def changed(old: str, new: str) -> str:
    """The good scene with one passage replaced; the passage must occur exactly once."""
    if GOOD_SCENE.count(old) != 1:
        raise ValueError(f"{old!r} does not occur once in the good scene")
    return GOOD_SCENE.replace(old, new)


def bad(name: str, old: str, new: str, *says: str) -> BadScene:
    return BadScene(name, changed(old, new), says)


_HUGE = "1" + "0" * 400
_BALL = 'objects[0] ("left ball")'

_FILES = [
    BadScene("an empty file", "", ("camera is missing",)),
    BadScene("a picture", b"\x89PNG\r\n\x1a\n\x00\xff\xd8", ("UTF-8", "TOML")),
    BadScene("text in UTF-16", GOOD_SCENE.encode("utf-16"), ("UTF-8",)),
    BadScene("zero bytes", b"\x00" * 64, ("TOML", "line 1", "column 1")),
    BadScene("a bare word", "camera\n", ("TOML", "line 1", "column 7")),
    BadScene("an open list", GOOD_SCENE + "x = [1, 2", ("TOML", "line 63")),
    BadScene("lists in lists", "x = " + "[" * 5000, ("nested too deeply",)),
    BadScene(
        "a number of 5000 digits", f"format = {'9' * 5000}", ("a number has thousands of digits",)
    ),
    BadScene("one table twice", GOOD_SCENE + "[camera]\n", ("TOML", "line 63", "camera")),
    BadScene("JSON", '{"camera": {}}', ("TOML", "line 1")),
    bad(
        "half a highlight",
        'method = "mis"',
        'method = "blinn"\nphong = { specular = 0.5 }',
        "render.phong: specular is given without exponent",
    ),
    bad(
        "a constant of no model",
        'method = "mis"',
        'method = "blinn"\nphong = { shine = 1 }',
        "render.phong: unknown key 'shine'",
        "Keys of [render.phong]: ambient, diffuse, specular, exponent",
    ),
    bad("constants in no table", 'method = "mis"', "phong = 2", "headed [render.phong], got 2"),
    BadScene(
        "nothing to see",
        "[camera]\nposition = [0, 0, 1]\nlook_at = [0, 0, 0]",
        ("nothing to see", "add an object", "background"),
    ),
]

_CAMERA = [
    BadScene("no camera", GOOD_SCENE[: GOOD_SCENE.index("[camera]")] + "[render]", ("camera is",)),
    bad("a list of cameras", "[camera]", "[[camera]]", "camera must be a table", "[camera]"),
    bad("no position", "position = [0.0, 0.0, 2.9]\n", "", "camera.position is missing"),
    bad("two coordinates", "[0.0, 0.0, 2.9]", "[0.0, 2.9]", "camera.position", "three numbers"),
    bad("one coordinate", "[0.0, 0.0, 2.9]", "[0.0]", "camera.position", "three", "list of 1"),
    bad("four coordinates", "[0.0, 0.0, 2.9]", "[0, 0, 0, 1]", "three numbers", "list of 4"),
    bad("a text as vector", "[0.0, 0.0, 2.9]", '"abc"', "camera.position", "three", '"abc"'),
    bad("a text in a vector", "[0.0, 0.0, 2.9]", '[0, "z", 1]', "camera.position[1]", '"z"'),
    bad("NaN", "[0.0, 0.0, 2.9]", "[0.0, nan, 2.9]", "camera.position[1]", "finite", "nan"),
    bad("inf", "[0.0, 0.0, 2.9]", "[0.0, 0.0, inf]", "camera.position[2]", "finite", "inf"),
    bad("a far camera", "[0.0, 0.0, 2.9]", "[0, 0, -1e16]", "camera.position[2]", "least -1e15"),
    bad("a huge integer", "[0.0, 0.0, 2.9]", f"[{_HUGE}, 0, 0]", "camera.position[0]", "digits"),
    bad("fov 0", "fov = 45.0", "fov = 0", "camera.fov must be greater than 0", "got 0"),
    bad("fov 180", "fov = 45.0", "fov = 180", "camera.fov must be less than 180", "got 180"),
    bad("fov as text", "fov = 45.0", 'fov = "wide"', "camera.fov must be a number", '"wide"'),
    bad("fov as truth", "fov = 45.0", "fov = true", "camera.fov must be a number", "true"),
    bad("fov as date", "fov = 45.0", "fov = 2020-01-01", "camera.fov must be a number", "date"),
    bad("a misspelt key", "look_at", "lookat", "camera: unknown key 'lookat'", "'look_at'?"),
    bad("focus 0", "focus_distance = 2.9", "focus_distance = 0.0", "focus_distance", "greater"),
    bad("a wide lens", "defocus_angle = 0.0", "defocus_angle = 180", "defocus_angle", "less than"),
    bad("a negative lens", "defocus_angle = 0.0", "defocus_angle = -1", "defocus_angle", "least 0"),
    bad("looking at itself", "look_at = [0.0, 0.0, 0.0]", "look_at = [0, 0, 2.9]", "camera: pos"),
    bad("up along the view", "up = [0.0, 1.0, 0.0]", "up = [0, 0, -3]", "camera: up is parallel"),
    bad("up nearly along it", "up = [0.0, 1.0, 0.0]", "up = [0, 1e-9, 1]", "up is parallel"),
    bad("up zero", "up = [0.0, 1.0, 0.0]", "up = [0, 0, 0]", "camera.up must not be zero"),
]

_RENDER = [
    bad("width 0", "width = 512", "width = 0", "render.width must be at least 1, got 0"),
    bad("width 20000", "width = 512", "width = 20000", "render.width must be at most 16384"),
    bad("width 512.5", "width = 512", "width = 512.5", "render.width", "whole number", "512.5"),
    bad("width as text", "width = 512", 'width = "512"', "render.width", "whole number", '"512"'),
    bad("height as truth", "height = 512", "height = true", "render.height", "whole", "true"),
    bad("a huge width", "width = 512", f"width = {_HUGE}", "render.width must be at most 16384"),
    bad("samples 0", "samples = 256", "samples = 0", "render.samples must be at least 1"),
    bad("2^20 + 1 samples", "samples = 256", "samples = 1048577", "samples", "most 1048576"),
    bad("bounces -1", "bounces = 10", "bounces = -1", "render.bounces must be at least 0, got -1"),
    bad("bounces 1001", "bounces = 10", "bounces = 1001", "render.bounces must be at most 1000"),
    bad("a misspelt method", '"mis"', '"miss"', "render.method", "unknown method 'miss'", "'mis'?"),
    bad("a number as method", '"mis"', "3", "render.method must be one of: naive, nee, mis"),
    bad("an unknown setting", "samples =", "sample =", "render: unknown key", "'samples'?"),
]

_LIGHTS = [
    bad("a misspelt group", "ceiling = 1.0", "celing = 1.0", "lights.celing", "'ceiling'?"),
    bad("no such group", "ceiling = 1.0", "xyz = 1.0", "lights.xyz", "background, ceiling"),
    bad("a negative intensity", "ceiling = 1.0", "ceiling = -1", "lights.ceiling must be at least"),
    bad("an intensity of text", "ceiling = 1.0", 'ceiling = "on"', "lights.ceiling", '"on"'),
    bad("a blinding lamp", "ceiling = 1.0", "ceiling = 1e15", "lights.ceiling", "emission", "1e15"),
    BadScene(
        "a blinding sky",
        changed("ceiling = 1.0", "background = 1e10").replace(
            "d]\ncolor = [0.0", "d]\ncolor = [1e10"
        ),
        ("lights.background", "radiance of the background must be at most 1e15"),
    ),
    bad("a lamp in the sky", '"ceiling"', '"background"', "materials.lamp.group", "background"),
    bad("a nameless group", '"ceiling"', '""', "materials.lamp.group must not be empty"),
    bad("a list of lights", "[lights]\n", "[[lights]]\n", "lights must be a table", "[lights]"),
]

_SKY = "[background]\ncolor = [0.0, 0.0, 0.0]"

_BACKGROUND = [
    bad("color and top", _SKY, _SKY + "\ntop = [1, 1, 1]", "background: bottom and top go"),
    bad("only top", _SKY, "[background]\ntop = [1, 1, 1]", "background: bottom and top go"),
    bad(
        "color and a gradient",
        _SKY,
        _SKY + "\nbottom = [1, 1, 1]\ntop = [1, 1, 1]",
        "background: color excludes bottom and top",
    ),
    bad("a negative sky", _SKY, "[background]\ncolor = [0, -1, 0]", "background.color[1]", "0"),
    bad(
        "a sky as a list",
        _SKY,
        "background = [0, 0, 0]",
        "unknown key 'background'",
        "above the first",
    ),
]

_MATERIALS = [
    bad("a list of materials", "[materials.white]", "[[materials]]", "tables", "[materials.NAME]"),
    bad("a material of text", "[lights]", "[materials]\nred = 'red'", "materials.red", "a table"),
    bad("an unknown type", '"lambertian"', '"lambert"', "white.type", "'lambertian'?", "metal"),
    bad("a type in capitals", '"lambertian"', '"Lambertian"', "did you mean 'lambertian'?"),
    bad("a type of number", '"lambertian"', "3", "materials.white.type must be one of", "got 3"),
    bad("no type", 'type = "lambertian"\n', "", "materials.white.type is missing", "dielectric"),
    bad("albedo above 1", "0.75]", "1.2]", "materials.white.color[2] must be at most 1, got 1.2"),
    bad("albedo just above 1", "0.75]", "1.00000001]", "at most 1, got 1.00000001"),
    bad("no albedo", "color = [0.75, 0.75, 0.75]\n", "", "materials.white.color is missing"),
    bad("very rough", "roughness = 0.0", "roughness = 2", "materials.steel.roughness", "most 1"),
    bad("ior 0", "ior = 1.5", "ior = 0", "materials.glass.ior must be greater than 0, got 0"),
    bad("a negative ior", "ior = 1.5", "ior = -1.5", "materials.glass.ior must be greater than 0"),
    bad("an infinite ior", "ior = 1.5", "ior = inf", "materials.glass.ior must be a finite"),
    bad("negative emission", "[8.0, ", "[-8, ", "materials.lamp.emission[0] must be at least 0"),
    bad("boundless emission", "[8.0, ", "[1e16, ", "materials.lamp.emission[0]", "at most 1e15"),
    bad("a material of no name", "[materials.white]", '[materials.""]', 'materials.""', "empty"),
    bad("a name of 999 letters", "[materials.white]", f"[materials.{'a' * 999}]\nx = 1", 'aaa..."'),
    bad("a name of two lines", "[materials.white]", '[materials."a\\nb"]', "its name", "one line"),
]

_OBJECTS = [
    BadScene(
        "objects as a table",
        GOOD_SCENE[: GOOD_SCENE.index("[[objects]]")] + "[objects.ball]",
        ("objects must be a list of tables", "[[objects]]"),
    ),
    BadScene(
        "objects as numbers",
        "objects = [1]\n" + GOOD_SCENE[: GOOD_SCENE.index("[[objects]]")],
        ("objects[0] must be a table", "got 1"),
    ),
    bad("an unknown shape", '"sphere"', '"spere"', f"{_BALL}.shape", "'sphere'?", "plane, quad"),
    bad("a shape of lists", '"sphere"', "[1]", f"{_BALL}.shape must be one of: sphere, plane"),
    bad("a shape of 6000 digits", '"sphere"', "0x" + "f" * 5000, f"{_BALL}.shape", "digits"),
    bad(
        "a shape of many lists", '"sphere"', f"[[[0x{'f' * 5000}]]]", f"{_BALL}.shape", "list of 1"
    ),
    bad("no shape", 'shape = "sphere"\n', "", f"{_BALL}.shape is missing", "sphere, plane, quad"),
    bad("a negative radius", "0.35\n", "-1\n", f"{_BALL}.radius must be greater than 0, got -1"),
    bad("a radius of zero", "0.35\n", "0.0\n", f"{_BALL}.radius must be greater than 0, got 0"),
    bad("a tiny radius", "0.35\n", "1e-20\n", f"{_BALL}.radius must be at least 1e-15"),
    bad("an infinite radius", "0.35\n", "inf\n", f"{_BALL}.radius must be a finite number"),
    bad("a misspelt radius", "radius", "raduis", f"{_BALL}: unknown key 'raduis'", "'radius'?"),
    bad("an unknown material", '"white"', '"wite"', f"{_BALL}.material", "'white'?", "lamp"),
    bad("a number as material", '"white"', "1", f"{_BALL}.material must be text in quotes"),
    bad("no material", 'material = "white"\n', "", f"{_BALL}.material is missing"),
    bad("a number as name", '"left ball"', "7", "objects[0].name must be text in quotes, got 7"),
    bad("a name of two lines there", "left ball", "a\\nb", "objects[0]", "name must be one line"),
    bad("a normal of zero", "normal = [0.0, 1.0, 0.0]", "normal = [0, 0, 0]", "objects[1].normal"),
    bad("a flat quad", "edge_v = [0.0, 0.0, 0.8]", "edge_v = [2, 0, 0]", "objects[2]: edge_u and"),
    bad("a sliver", "edge_v = [0.0, 0.0, 0.8]", "edge_v = [8, 0, 1e-6]", "objects[2]", "parallel"),
    bad("an edge of zero", "edge_u = [0.8, 0.0, 0.0]", "edge_u = [0, 0, 0]", "objects[2].edge_u"),
    bad("a glass quad", '"lamp"\n', '"glass"\n', "objects[2]: a quad", "dielectric", "sphere"),
]

_SCENE = [
    bad("an unknown table", "[camera]", "[camra]", "unknown key 'camra'", "did you mean 'camera'?"),
    bad("format 2", "format = 1", "format = 2", "format must be 1", "version"),
    bad("format as truth", "format = 1", "format = true", "format must be a whole number"),
    bad("a title of two lines", "glass ball", "glass\\nball", "title must be one line"),
    bad("a number as title", '"A matte and a glass ball in a box"', "7", "title must be text"),
    BadScene(
        "five mistakes",
        changed("fov = 45.0", "fov = 0")
        .replace("0.75", "7")
        .replace("radius = 0.35", "radius = 0"),
        ("camera.fov", "white.color[0]", "white.color[1]", "are 2 other problems"),
    ),
    BadScene(
        "four mistakes",
        changed("fov = 45.0", "fov = 0").replace("0.75", "7"),
        ("camera.fov", "white.color[1]", "is 1 other problem."),
    ),
]

BAD_SCENES = [
    *_FILES,
    *_CAMERA,
    *_RENDER,
    *_LIGHTS,
    *_BACKGROUND,
    *_MATERIALS,
    *_OBJECTS,
    *_SCENE,
]
