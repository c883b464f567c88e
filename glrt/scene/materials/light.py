"""Surfaces of lamps."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Literal

from pydantic import Field

from glrt.scene.lights.cone import Cone
from glrt.scene.materials.base import RADIANCE, Opaque
from glrt.scene.values import BLACK, Color, Radiance, Triple


class Light(Opaque):
    """An area light, evenly bright in all directions unless it has a cone."""

    type: Literal["light"] = Field("light", description="the kind of material")
    color: Color = Field(BLACK, description="albedo of the lamp itself")
    emission: Radiance = Field(description=RADIANCE)

    if TYPE_CHECKING:

        def __init__(
            self,
            *,
            emission: Triple,
            color: Triple = BLACK,
            group: str | None = None,
            cone: Cone | Mapping[str, Any] | None = None,
        ) -> None: ...

    @property
    def emits(self) -> bool:
        """True: it stays a lamp even if its emission is black."""
        return True
