"""Light from infinitely far away."""

from typing import TYPE_CHECKING, Annotated, Self

from pydantic import Field, model_validator

from glrt.scene.values import BLACK, Radiance, Triple, Value
from glrt.settings import Cost, Editable


class Background(Value):
    """Light from infinitely far away: one colour, or a vertical gradient, or two."""

    color: Annotated[Radiance | None, Editable(Cost.RECOMPILE)] = Field(
        None,
        description="radiance from every direction; default: black",
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
            bottom: Triple | None = None,
            horizon: Triple | None = None,
            top: Triple | None = None,
        ) -> None: ...

    @property
    def gradient(self) -> tuple[Radiance, ...]:
        """Radiance from straight below, the horizon where it is given, and straight above."""
        flat = self.color or BLACK
        middle = () if self.horizon is None else (self.horizon,)
        return (self.bottom or flat, *middle, self.top or flat)

    @model_validator(mode="after")
    def _is_given_one_way(self) -> Self:
        if (self.bottom is None) != (self.top is None):
            raise ValueError("bottom and top go together; give both, or color alone")
        if self.horizon is not None and self.top is None:
            raise ValueError("horizon goes with bottom and top; give all three, or color alone")
        if self.color is not None and self.top is not None:
            raise ValueError("color excludes bottom and top; give color alone, or bottom and top")
        return self
