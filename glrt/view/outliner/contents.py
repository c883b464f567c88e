"""Rows of the list of what a scene holds: in groups that can be folded, or found by words."""

from collections.abc import Collection, Iterator
from typing import Literal, NamedTuple

from glrt.core.memo import kept_for_the_same
from glrt.scene.lit_scene import SKY_GROUP, SUN_GROUP
from glrt.scene.materials.base import Opaque
from glrt.scene.scene import Scene
from glrt.scene.shapes.kinds import Shape
from glrt.view.edits.state_differences import name_of

Kind = Literal["camera", "group", "background", "sun", "object", "medium"]
CAMERA = "camera"
LIGHT, OBJECTS, MEDIA = "light", "objects", "media"  # groups


class Entry(NamedTuple):
    """A row; `number` is that of an object, or the number of rows in a group."""

    kind: Kind
    name: str = ""
    number: int = 0

    @property
    def key(self) -> tuple[str, str, int]:
        """Identity of the row, whatever else is listed."""
        return self.kind, self.name, self.number if self.kind == "object" else 0


def text_of(entry: Entry, objects: tuple[Shape, ...]) -> str:
    """Return the text of a row; an object without a name has its shape and material."""
    if entry.kind == "object":
        return name_of(objects[entry.number])
    return entry.name


def entries_of(scene: Scene, words: str, folded: Collection[str]) -> list[Entry]:
    """Return the rows: those with all the words, or without words those of unfolded groups."""
    wanted = words.lower().split()
    shown = [] if wanted and not _has(wanted, CAMERA) else [Entry("camera", CAMERA)]
    for group, members in _groups(scene).items():
        found = [it for it in members if _is_found(it, wanted, scene)] if wanted else members
        if found:
            shown.append(Entry("group", group, len(found)))
            shown += found if wanted or group not in folded else []
    return shown


@kept_for_the_same
def _groups(scene: Scene) -> dict[str, list[Entry]]:
    """Return lamps with the light that comes from infinity, other objects, and media."""
    shining = {n for n, it in scene.materials.items() if isinstance(it, Opaque) and it.emits}
    groups: dict[str, list[Entry]] = {LIGHT: list(_from_infinity(scene)), OBJECTS: []}
    for number, shape in enumerate(scene.objects):
        groups[LIGHT if shape.material in shining else OBJECTS].append(Entry("object", "", number))
    groups[MEDIA] = [Entry("medium", name) for name in scene.media]
    return groups


def _from_infinity(scene: Scene) -> Iterator[Entry]:
    if any(map(any, scene.background.gradient)):
        yield Entry("background", SKY_GROUP)
    if scene.sun:
        yield Entry("sun", SUN_GROUP)


def _is_found(entry: Entry, words: list[str], scene: Scene) -> bool:
    if entry.kind != "object":
        return _has(words, f"{entry.name} {entry.kind}")
    shape = scene.objects[entry.number]
    text = f"{entry.number} {shape.name or ''} {shape.shape} {shape.material} {shape.medium or ''}"
    return _has(words, text)


def _has(words: list[str], text: str) -> bool:
    text = text.lower()
    return all(word in text for word in words)


kept_entries = kept_for_the_same(entries_of)
