"""Scenes as tables, by the grammar of the format, with numbers from where trouble lives."""

from typing import Any

from hypothesis import strategies as st

from glrt.scene.values import LARGEST, SMALLEST

Table = dict[str, Any]

NAMES = st.sampled_from(["a", "b", "glas", "lampe", "ü", "with space", "background"])
EDGES = [0.0, -0.0, 1.0, -1.0, 0.5, 5e-324, 1e-38, SMALLEST, 1e-7, 1e7, LARGEST, -LARGEST]
NUMBERS = st.one_of(
    st.floats(-4, 4),
    st.floats(-4, 4),
    st.integers(-3, 3),
    st.sampled_from(EDGES),
    st.floats(-LARGEST, LARGEST),
)
LENGTHS = st.one_of(st.floats(0.01, 3), st.floats(0.01, 3), st.floats(SMALLEST, LARGEST))
FRACTIONS = st.one_of(st.floats(0, 1), st.sampled_from([0, 1, 5e-324, 1e-8, 1 - 1e-8]))
RADIANCES = st.one_of(st.floats(0, 10), st.floats(0, LARGEST), st.just(0))


def triples(numbers: st.SearchStrategy[Any]) -> st.SearchStrategy[list[Any]]:
    """Three numbers."""
    return st.lists(numbers, min_size=3, max_size=3)


def tables(
    optional: dict[str, st.SearchStrategy[Any]] | None = None, **required: st.SearchStrategy[Any]
) -> st.SearchStrategy[Table]:
    """A table with these keys."""
    return st.fixed_dictionaries(required, optional=optional or {})


POINTS = triples(NUMBERS)
COLORS = triples(FRACTIONS)

LENSES = {
    "fov": st.floats(0, 180, exclude_min=True, exclude_max=True),
    "focus_distance": LENGTHS,
    "defocus_angle": st.one_of(st.floats(0, 5), st.floats(0, 179.99)),
}
CAMERAS = st.one_of(
    tables(LENSES, position=triples(st.floats(1, 3)), look_at=triples(st.floats(-1, 0.5))),
    tables(LENSES, position=triples(st.floats(1, 3)), look_at=triples(st.floats(-1, 0.5))),
    tables({"up": POINTS, **LENSES}, position=POINTS, look_at=POINTS),
)
SETTINGS = tables(
    {
        "bounces": st.integers(0, 12),
        "method": st.sampled_from(["naive", "nee", "mis"]),
        "samples": st.integers(1, 4),
    },
    width=st.integers(1, 8),
    height=st.integers(1, 8),
)
SKIES: st.SearchStrategy[Table] = st.one_of(
    st.just({}),
    tables(color=triples(RADIANCES)),
    tables({"horizon": triples(RADIANCES)}, bottom=triples(RADIANCES), top=triples(RADIANCES)),
)
PAIRS = st.lists(NUMBERS, min_size=2, max_size=2)
WRAPS = st.sampled_from(["repeat", "mirror", "clamp"])
PLACING = {
    "scale": st.one_of(NUMBERS, PAIRS),
    "offset": PAIRS,
    "rotation": st.floats(-720, 720),
    "wrap": st.one_of(WRAPS, st.lists(WRAPS, min_size=2, max_size=2)),
    "factor": FRACTIONS,
}


def boards(values: st.SearchStrategy[Any]) -> st.SearchStrategy[Table]:
    """Textures that need no file."""
    return tables(PLACING, checker=st.lists(values, min_size=2, max_size=2))


PRINCIPLED = {
    "metallic": st.one_of(FRACTIONS, boards(FRACTIONS)),
    "roughness": st.one_of(FRACTIONS, FRACTIONS, boards(FRACTIONS)),
    "alpha": st.one_of(FRACTIONS, boards(FRACTIONS)),
    "alpha_cutoff": FRACTIONS,
    "clearcoat": FRACTIONS,
    "anisotropy": FRACTIONS,
    "anisotropy_rotation": st.floats(-720, 720),
    "sheen": COLORS,
    "diffuse_transmission": FRACTIONS,
    "diffuse_transmission_color": COLORS,
    "sheen_roughness": FRACTIONS,
    "iridescence": FRACTIONS,
    "iridescence_ior": st.floats(1, 4),
    "iridescence_thickness": st.floats(0, 2000),
}
MATERIALS = st.one_of(
    tables(type=st.just("lambertian"), color=COLORS),
    tables(type=st.just("lambertian"), color=boards(st.one_of(COLORS, FRACTIONS))),
    tables(PRINCIPLED, type=st.just("principled"), color=st.one_of(COLORS, boards(COLORS))),
    tables({"roughness": FRACTIONS}, type=st.just("metal"), color=COLORS),
    tables({"ior": st.one_of(st.floats(0.5, 3), LENGTHS)}, type=st.just("dielectric")),
    tables({"dispersion": st.floats(0, 10)}, type=st.just("dielectric")),
    tables({"color": COLORS, "group": NAMES}, type=st.just("light"), emission=triples(RADIANCES)),
)
SHAPES = st.one_of(
    tables(shape=st.just("sphere"), center=POINTS, radius=LENGTHS),
    tables(shape=st.just("plane"), point=POINTS, normal=POINTS),
    tables(shape=st.just("disk"), center=POINTS, normal=POINTS, radius=LENGTHS),
    tables({"rotate": POINTS}, shape=st.just("box"), min=POINTS, max=POINTS),
    tables(
        {"capped": st.booleans(), "from": POINTS},
        shape=st.just("cylinder"),
        to=POINTS,
        radius=LENGTHS,
    ),
    tables(shape=st.just("quad"), corner=POINTS, edge_u=POINTS, edge_v=POINTS),
)


@st.composite
def scenes(draw: st.DrawFn) -> Table:
    """A scene whose parts each follow the grammar; most of them fit together."""
    materials = draw(st.dictionaries(NAMES, MATERIALS, min_size=1, max_size=5))
    shapes = draw(st.lists(SHAPES, max_size=8))
    of = st.sampled_from(sorted(materials))
    lamps = sorted(name for name, made in materials.items() if made["type"] == "light")
    groups = sorted({materials[name].get("group", name) for name in lamps} | {"background"})
    return {
        "camera": draw(CAMERAS),
        "render": draw(SETTINGS),
        "background": draw(SKIES),
        "materials": materials,
        "lights": draw(st.dictionaries(st.sampled_from(groups), RADIANCES, max_size=2)),
        "objects": [{**shape, "material": draw(of)} for shape in shapes],
    }
