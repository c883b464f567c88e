"""Matte (Lambertian) surfaces."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, ClassVar, Literal

from pydantic import Field

from glrt.scene.lights.cone import Cone
from glrt.scene.materials.base import Opaque
from glrt.scene.materials.textures import Texture
from glrt.scene.values import BLACK, Color, Triple


class Lambertian(Opaque):
    """A matte (Lambertian) surface."""

    type: Literal["lambertian"] = Field("lambertian", description="the kind of material")
    color: Color = Field(description="albedo, 0 to 1 each, or a texture")
    color_map: Texture | None = None

    textured: ClassVar[Mapping[str, bool]] = {"color": True}

    if TYPE_CHECKING:

        def __init__(
            self,
            *,
            color: Triple | Texture,
            emission: Triple = BLACK,
            group: str | None = None,
            cone: Cone | Mapping[str, Any] | None = None,
        ) -> None: ...
