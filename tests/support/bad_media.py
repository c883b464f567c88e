"""Scene files whose media must be refused."""

from tests.support.bad_scenes import BadScene, bad

_BALL = 'objects[0] ("left ball")'


def _fog(name: str, keys: str, *says: str, material: str = "none", more: str = "") -> BadScene:
    """The good scene with a medium of these keys in its ball of this material."""
    return bad(
        name,
        'radius = 0.35\nmaterial = "white"\n',
        f'radius = 0.35\nmaterial = "{material}"\nmedium = "fog"\n{more}\n[media.fog]\n{keys}\n',
        *says,
    )


def _of_glass(name: str, keys: str, *says: str) -> BadScene:
    """The same with a ball of glass of these keys."""
    found = _fog(name, "", *says, material="glass")
    return found._replace(content=str(found.content).replace("ior = 1.5", f"ior = 1.5\n{keys}"))


def _scan(
    name: str, changes: dict[str, str], *says: str, more: str = "", grid: str = 'file = "a.npy"'
) -> BadScene:
    """The same with a grid and a transfer function of two knots, with other keys."""
    keys = {"values": "[0, 1]", "colors": "[[0, 0, 0], [1, 1, 1]]", "opacities": "[0, 0.5]"}
    given = {**keys, "length": "1", **changes}
    inner = ", ".join(f"{key} = {value}" for key, value in given.items() if value)
    density = f"density = {{ {grid} }}\n" if grid else ""
    return _fog(name, f"{density}transfer = {{ {inner} }}\n{more}", "media.fog", *says)


BAD_MEDIA = [
    _fog(
        "light that grows", "scattering = [1, -2, 1]", "media.fog.scattering[1] must be at least 0"
    ),
    _fog("absorption of NaN", "absorption = [nan, 1, 1]", "media.fog.absorption[0]", "finite"),
    _fog(
        "one number for three", "absorption = 1", "media.fog.absorption", "three numbers", "got 1"
    ),
    _fog("light that never turns", "anisotropy = 1", "media.fog.anisotropy", "at most 0.99"),
    _fog("light that turns back", "anisotropy = -1", "media.fog.anisotropy", "at least -0.99"),
    _fog("a dark glow", "emission = [0, 0, -1]", "media.fog.emission[2] must be at least 0"),
    _fog("a key of no medium", "scatering = [1, 1, 1]", "media.fog", "'scattering'?"),
    _fog("smoke as a path", 'density = "a.npy"', "media.fog.density", "table"),
    _fog("smoke without a file", "density.scale = 2", "media.fog.density.file is missing"),
    _fog("a misspelt grid", 'density = { fle = "a.npy" }', "media.fog.density", "'file'?"),
    _fog(
        "smoke in half a box",
        'density = { file = "a.npy", min = [0, 0, 0] }',
        "media.fog.density",
        "both min and max",
    ),
    _fog(
        "smoke in a flat box",
        'density = { file = "a.npy", min = [0, 0, 0], max = [1, 0, 1] }',
        "media.fog.density",
        "min below max",
    ),
    _fog(
        "smoke of less than nothing",
        'density = { file = "a.npy", scale = -1 }',
        "media.fog.density.scale must be at least 0",
    ),
    _scan("a scan without a length", {"length": ""}, ".length is missing; add it"),
    _scan("a knot of no light", {"opacities": "[0, 1]"}, ".opacities[1] must be less than 1"),
    _scan("a knot below nothing", {"opacities": "[-1, 0]"}, ".opacities[0] must be at least 0"),
    _scan("a knot without opacity", {"opacities": "[0]"}, "2 values, 2 colors and 1 opacities"),
    _scan("knots out of order", {"values": "[2, 1]"}, "values must not fall"),
    _scan("one knot as a number", {"values": "1"}, ".values must be a list, got 1"),
    _scan("no knots", {"values": "[]"}, ".values must be a list of at least 1"),
    _scan(
        "33 knots",
        {"values": f"{[*range(33)]}"},
        ".values must be a list of at most 32, got one of 33",
    ),
    _scan("a knot of NaN", {"values": "[0, nan]"}, ".values[1]", "finite"),
    _scan("a grey knot", {"colors": "[1, 1]"}, ".colors[0] must be a list of three numbers"),
    _scan("a dark knot", {"colors": "[[0, 0, 0], [0, -1, 0]]"}, ".colors[1][1] must be at least 0"),
    _scan("a scan of no length", {"length": "0"}, ".length must be greater than 0"),
    _scan("a misspelt knot", {"colours": "[]"}, "'colors'?"),
    _fog("a scan as a number", "transfer = 1", "media.fog.transfer must be a table"),
    _scan(
        "a scan that scatters",
        {},
        "takes the place of scattering and anisotropy",
        more="scattering = [1, 1, 1]\nanisotropy = 0.5",
    ),
    _scan("a scan of nothing", {}, "transfer needs density", grid=""),
    bad(
        "a medium that is none", '"white"\n', '"none"\nmedium = "fog"\n', f"{_BALL}.medium", "'fog'"
    ),
    bad("an open bound", '"lamp"\n', '"none"\n', "objects[2].material", "this quad encloses none"),
    _fog("fog in chalk", "", f"{_BALL}.medium", "light does not enter", material="white"),
    _fog("fog in a lamp", "", f"{_BALL}.medium", "light does not enter", material="lamp"),
    _of_glass("fog in a pane", "thin = true", f"{_BALL}.medium", "light does not enter"),
    _of_glass("fog in frosted glass", "roughness = 0.3", f"{_BALL}.medium", "smooth glass"),
    _of_glass(
        "fog in tinted glass",
        "attenuation_color = [0.5, 0.5, 0.5]\nattenuation_distance = 1",
        f"{_BALL}.medium",
        "attenuation_color",
    ),
    bad(
        "chalk with priority",
        'radius = 0.35\nmaterial = "white"\n',
        'radius = 0.35\nmaterial = "white"\npriority = 1\n',
        f"{_BALL}.priority",
        "light does not enter",
    ),
    bad(
        "an endless glow",
        "format = 1",
        'format = 1\nmedium = "fog"\nmedia = { fog = { emission = [1, 1, 1] } }',
        "media.fog.emission",
        "infinitely bright",
    ),
    bad(
        "nine media",
        "format = 1",
        f"format = 1\nmedia = {{ {', '.join(f'm{k} = {{}}' for k in range(9))} }}",
        "media must be at most 8",
    ),
    bad(
        "a medium below a table",
        "defocus_angle = 0.0",
        'defocus_angle = 0.0\nmedium = "fog"',
        "unknown key 'medium'",
        "above the first [table]",
    ),
]
