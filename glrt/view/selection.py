"""The selected object of the window, and the edits of objects by buttons and keys."""

import math
from collections.abc import Callable
from functools import partial
from pathlib import Path

from glrt.scene.scene import Scene
from glrt.scene.shapes.kinds import Shape
from glrt.view.camera_moves import CameraMoves
from glrt.view.controls import replaced
from glrt.view.edits.locks import check_locks
from glrt.view.edits.new_objects import two_digits, with_model, with_new_near
from glrt.view.edits.scene_edits import with_duplicate, with_objects, without_objects
from glrt.view.edits.state_differences import name_of
from glrt.view.edits.texture_images import with_texture_image
from glrt.view.viewport import orbit
from glrt.view.viewport.pick import Picked, pick
from glrt.view.viewport.transform import clear_of

SIZE = 0.07  # half the size of a new object, in distances from the camera to the pivot


class Selection(CameraMoves):
    """Selects, adds, copies, deletes, hides and locks objects of a session."""

    selected: int | None  # number of the selected object
    _others: tuple[object, frozenset[int]] = (None, frozenset())  # and what they go with
    is_to_be_seen: bool  # whether the panel is to scroll to the selected object

    def edit_scene(self, gesture: str, make: Callable[[Scene], Scene]) -> None:
        """Replace the scene by the result of `make`; an invalid scene is reported, not raised.

        So is a scene in which a locked object has changed.
        """
        with self.messages.reporting():
            scene = make(self.session.scene)
            check_locks(self.session.state.locked, self.session.scene, scene)
            self.session.edit(scene, gesture)

    @property
    def selected_shape(self) -> Shape | None:
        """The selected object; None if nothing is selected or the object no longer exists."""
        objects = self.session.scene.objects
        index = self.selected
        return objects[index] if index is not None and index < len(objects) else None

    @property
    def chosen(self) -> frozenset[int]:
        """Numbers of all selected objects; those in addition to `selected` go when it changes."""
        if self.selected_shape is None or self.selected is None:
            return frozenset()
        of, others = self._others
        return frozenset({self.selected}) | (others if of == self._place else frozenset())

    @property
    def _place(self) -> object:
        return self.selected, len(self.session.scene.objects)

    def select_also(self, index: int) -> None:
        """Select one more object, whose values the panel then has, or no longer select it."""
        chosen = self.chosen
        left = chosen - {index}
        if index in chosen:
            self.selected = self.selected if self.selected in left else max(left, default=None)
        else:
            self.selected = index
        self._others = self._place, left

    @property
    def is_locked(self) -> bool:
        """Whether the selected object is locked against edits."""
        return self.selected in self.session.state.locked

    def select(self, index: int | None) -> None:
        """Select an object by its number, or nothing; the panel scrolls to the object."""
        self.selected, self.is_to_be_seen = index, index is not None

    def show_object(self, index: int, wanted: bool) -> None:
        """Show a hidden object or hide it, also if it is locked; a selected one with all others."""
        numbers = self.chosen if index in self.chosen else {index}
        with self.messages.reporting():
            hide = partial(replaced, hidden=not wanted)
            self.session.edit(with_objects(self.session.scene, numbers, hide))

    def add(self, kind: str) -> None:
        """Add an object of a kind at the pivot or on what is there, and select it."""
        self._add(lambda scene: with_new_near(scene, kind, self.pivot, SIZE * self.reach))

    def add_model(self, path: Path) -> None:
        """Add the meshes of a model at the pivot, and select the first."""
        self._add(lambda scene: with_model(scene, path, self.pivot, 2 * SIZE * self.reach))

    def lay_image(self, path: Path, x: float, y: float) -> None:
        """Make an image the color of the object under a point of the picture, as in `pick`."""
        picked = self.pick(x, y) if 0 <= x <= 1 and 0 <= y <= 1 else None
        if picked is None:
            self.messages.complain(
                f"{path.name} was dropped where no object is. Drop it on an object in the "
                "picture: it becomes the color of that."
            )
            return
        before = self.session.scene
        self.edit_scene("", partial(with_texture_image, index=picked.number, path=path))
        if self.session.scene is not before:
            self.select(picked.number)
            name = name_of(self.session.scene.objects[picked.number])
            self.messages.report(f"{path.name} is the color of {name}; undo takes it off again")

    def duplicate(self) -> None:
        """Add a copy of the selected object above or below it, and select the copy."""
        if (shape := self.selected_shape) and self.selected is not None:
            copy = clear_of(shape, self.pivot, two_digits(SIZE * self.reach))
            self._add(partial(with_duplicate, index=self.selected, moved=copy))

    def _add(self, make: Callable[[Scene], Scene]) -> None:
        count = len(self.session.scene.objects)
        self.edit_scene("", make)
        if len(self.session.scene.objects) > count:
            self.select(count)

    def delete(self) -> None:
        """Delete the selected objects, unless one is locked."""
        if numbers := self.chosen:
            count = len(self.session.scene.objects)
            self.edit_scene("", partial(without_objects, numbers=numbers))
            if len(self.session.scene.objects) < count:
                self.selected = None

    def pick(self, x: float, y: float) -> Picked | None:
        """Return the object under a point of the picture, (0, 0) upper left to (1, 1), or None."""
        settings = self.session.settings
        return pick(self.session.scene, settings.width / settings.height, x, y)

    def frame_selected(self) -> None:
        """Look at the selected object so that it fills the frame, and make it the pivot."""
        if shape := self.selected_shape:
            with self.messages.reporting():
                reach = shape.reach if math.isfinite(shape.reach) else 1.0
                self.place(orbit.framed(self.camera, shape.middle, reach))
                self.pivot = shape.middle
