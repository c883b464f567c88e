"""Places of the shaders that must name each kind of shape, and kinds that they do not name."""

import re
from collections.abc import Collection, Sequence
from pathlib import Path

BY_TREE = ("mesh",)  # kinds that the loops over all shapes leave out: only trees hold triangles


def unnamed(kinds: Sequence[str], in_leaves: Collection[str], shaders: Path) -> dict[str, set[str]]:
    """Kinds that a file of shapes/ does not name, by file; none where all are named.

    Rays find a kind that is missing in find_hit.glsl or tree.glsl in small or in large scenes
    alone. `in_leaves`: kinds that leaves of the tree hold.
    """
    texts = {name: (shaders / "shapes" / name).read_text() for name in FILES}
    search = re.search(
        r"^Hit find_in_loops\(.*?^}", texts["find_hit.glsl"], re.MULTILINE | re.DOTALL
    )
    assert search
    asked = {name.lower() for name in re.findall(r"\bHAS_([A-Z]+)\b", search[0])}
    loops = asked & set(re.findall(r"\b(\w+)_distance\(ray", texts["find_hit.glsl"]))
    leaves = {name.lower() for name in re.findall(r"kind == ([A-Z]+)\b", texts["tree.glsl"])}
    found = {
        "find_hit.glsl": set(kinds) - loops - set(BY_TREE),
        "tree.glsl": set(in_leaves) - leaves,
        "surface.glsl": set(kinds) - set(order_of_surfaces(shaders)),
    }
    return {name: missing for name, missing in found.items() if missing}


def order_of_surfaces(shaders: Path) -> list[str]:
    """Kinds in the order in which surface.glsl asks for them."""
    return re.findall(r"up_to_(\w+)\(", (shaders / "shapes" / "surface.glsl").read_text())


FILES = ("find_hit.glsl", "tree.glsl", "surface.glsl")
