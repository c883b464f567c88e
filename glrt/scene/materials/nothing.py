"""Bounds of volumes that are no surface."""

from typing import TYPE_CHECKING, Literal

from pydantic import Field

from glrt.scene.materials.base import Surface


class Nothing(Surface):
    """No surface: light goes straight on, and the medium inside the object begins or ends."""

    type: Literal["none"] = Field("none", description="the kind of material")
    is_transparent = True

    if TYPE_CHECKING:

        def __init__(self) -> None: ...
