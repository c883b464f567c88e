"""Choose the meshes with a BVH of their own: their triangles are kept once, wherever they stand.

Rays take more work to enter such a BVH, and a mesh that moves needs no new one.
"""

from collections.abc import Collection, Mapping, Sequence
from typing import Literal

from glrt.scene.materials.kinds import Material
from glrt.scene.shapes.mesh import Mesh

# "repeated": meshes used more than once, where that saves much. "large": all large ones as well.
# "moved": repeated ones, and all large ones once a large one is moved.
Apart = Literal["repeated", "moved", "large"]

LEAST_SAVED = 1_000_000  # triangles that copies would add: 90 MB (docs/results/speed.md)
LEAST_LARGE = 20_000  # triangles of a mesh: a smaller one that moves gets a new BVH at once


def with_own_tree(
    meshes: Sequence[Mesh], materials: Mapping[str, Material], apart: Apart = "repeated"
) -> tuple[int, ...]:
    """Return the numbers of the visible meshes that have a BVH of their own.

    Lamps have none, for each of their triangles is sampled where it stands.
    """
    alike: dict[object, list[int]] = {}
    for number, mesh in enumerate(meshes):
        if not materials[mesh.material].emits:
            alike.setdefault(mesh.form, []).append(number)
    chosen: list[int] = []
    for numbers in alike.values():
        triangles = len(meshes[numbers[0]].triangles.faces)
        is_repeated = triangles * (len(numbers) - 1) >= LEAST_SAVED
        if is_repeated or (apart == "large" and triangles >= LEAST_LARGE):
            chosen += numbers
    return tuple(sorted(chosen))


def after_moves(apart: Apart, before: Sequence[Mesh], after: Sequence[Mesh]) -> Apart:
    """Return `apart` after an edit of meshes: "moved" becomes "large" if a large one moved."""
    if apart != "moved" or len(before) != len(after):
        return apart
    pairs = zip(before, after, strict=True)
    is_moved = any(
        (old.linear != new.linear).any() or (old.origin != new.origin).any()
        for old, new in pairs
        if old.file == new.file and old is not new
        if len(new.triangles_of_file.faces) >= LEAST_LARGE
    )
    return "large" if is_moved else apart


def distinct(meshes: Sequence[Mesh]) -> tuple[list[Mesh], list[int]]:
    """Return the first mesh of each form, and for each mesh the number of its first."""
    numbers: dict[object, int] = {}
    first: list[Mesh] = []
    kinds: list[int] = []
    for mesh in meshes:
        kinds.append(numbers.setdefault(mesh.form, len(first)))
        first += [mesh] if kinds[-1] == len(first) else []
    return first, kinds


def tree_sizes(meshes: Sequence[Mesh], own: Collection[int]) -> tuple[int, list[int]]:
    """Return the triangles in the BVH of the scene, and in each own BVH of the meshes `own`."""
    sizes = [len(mesh.triangles.faces) for mesh in meshes]
    first = distinct([meshes[number] for number in own])[0]
    shared = sum(sizes) - sum(sizes[number] for number in own)
    return shared, [len(mesh.triangles.faces) for mesh in first]
