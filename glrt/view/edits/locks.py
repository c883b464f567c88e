"""Locks of objects against edits, by the numbers of the objects in the scene."""

from glrt.core.errors import UsageError
from glrt.scene.scene import Scene
from glrt.scene.shapes.kinds import Shape
from glrt.view.edits.state_differences import name_of

Locks = frozenset[int]


def followed(locked: Locks, before: tuple[Shape, ...], after: tuple[Shape, ...]) -> Locks:
    """Return the numbers of the locked objects after an edit that may add or remove objects."""
    if not locked or len(before) == len(after):
        return locked
    held = {id(before[number]) for number in locked}
    return frozenset(number for number, shape in enumerate(after) if id(shape) in held)


def check_locks(locked: Locks, before: Scene, after: Scene) -> None:
    """Raise `UsageError` if an edit changes or removes a locked object.

    A material that the object shares with others may have changed.
    """
    there = set(map(id, after.objects)) if locked else set()
    for number in sorted(locked):
        shape = before.objects[number]
        if id(shape) not in there:
            raise UsageError(
                f"{name_of(shape)} (object {number}) is locked. Its lock in the list of the part "
                "Scene opens it."
            )
