"""Light from infinitely far away."""

from typing import TYPE_CHECKING, Annotated, Self

from pydantic import Field, model_validator

from glrt.scene.files.named_images import ImageFile, NamedImage
from glrt.scene.lights.clear_sky import ClearSky
from glrt.scene.values import BLACK, WHITE, Angle, Number, Radiance, Triple, Value
from glrt.settings import Cost, Editable


class Background(Value):
    """Light from infinitely far away.

    A colour, one or two vertical gradients, an image, or a clear sky.
    """

    color: Annotated[Radiance | None, Editable(Cost.RECOMPILE)] = Field(
        None,
        description="radiance from every direction, default: black; with an image, a factor of "
        "its radiance, default: white",
    )
    image: NamedImage | None = Field(
        None,
        description="path of an image of all directions, .hdr or .exr, also .png, .jpg or .webp: "
        "the top row is straight up, the middle column -z, three quarters of the width +x",
    )
    rotation: Annotated[Angle | None, Editable(Cost.RESTART, "degrees", (-180, 180))] = Field(
        None,
        description="turns the image about the y axis: 90 moves what stood at -z to -x; default: 0",
    )
    sky: ClearSky | None = Field(
        None, description="a clear sky for the direction of [sun], which it needs"
    )
    bottom: Annotated[Radiance | None, Editable(Cost.RECOMPILE)] = Field(
        None,
        description="radiance from straight below; needs top",
    )
    horizon: Annotated[Radiance | None, Editable(Cost.RECOMPILE)] = Field(
        None,
        description="radiance from straight ahead, and the start of a gradient to each side; "
        "default: one gradient from bottom to top",
    )
    top: Annotated[Radiance | None, Editable(Cost.RECOMPILE)] = Field(
        None,
        description="radiance from straight above; needs bottom",
    )

    if TYPE_CHECKING:

        def __init__(
            self,
            *,
            color: Triple | None = None,
            image: ImageFile | str | None = None,
            rotation: Number | None = None,
            sky: ClearSky | None = None,
            bottom: Triple | None = None,
            horizon: Triple | None = None,
            top: Triple | None = None,
        ) -> None: ...

    @property
    def gradient(self) -> tuple[Radiance, ...]:
        """Radiance from straight below, the horizon where it is given, and straight above.

        With an image or a clear sky, the factor of its radiance.
        """
        if self.sky:
            return ((self.sky.scale,) * 3,) * 2
        flat = self.color or (WHITE if self.image else BLACK)
        middle = () if self.horizon is None else (self.horizon,)
        return (self.bottom or flat, *middle, self.top or flat)

    @property
    def is_pictured(self) -> bool:
        """Whether an image gives its radiance, from a file or of a clear sky."""
        return self.image is not None or self.sky is not None

    @model_validator(mode="after")
    def _is_given_one_way(self) -> Self:
        if (self.bottom is None) != (self.top is None):
            raise ValueError("bottom and top go together; give both, or color alone")
        if self.horizon is not None and self.top is None:
            raise ValueError("horizon goes with bottom and top; give all three, or color alone")
        if self.color is not None and self.top is not None:
            raise ValueError("color excludes bottom and top; give color alone, or bottom and top")
        if self.image is not None and self.top is not None:
            raise ValueError("image excludes bottom and top; give image alone, or with color")
        if self.sky is not None and (self.color or self.image or self.top):
            raise ValueError("sky excludes color, image, bottom and top; give sky alone")
        if self.rotation is not None and self.image is None:
            raise ValueError("rotation turns an image; give image, or leave rotation out")
        return self
