"""The grid of probes that a scene may give."""

from typing import TYPE_CHECKING, Annotated, Self

from pydantic import Field, model_validator

from glrt.scene.values import Triple, Value, Vector
from glrt.settings import Cost, Editable

MOST_PROBES = 4096  # in a grid
Count = Annotated[int, Field(ge=2, le=64)]


class Probes(Value):
    """A box of equal cells, with a probe in the middle of each."""

    min: Annotated[Vector, Editable(Cost.RESTART)] = Field(
        description="its corner with the least coordinates"
    )
    max: Annotated[Vector, Editable(Cost.RESTART)] = Field(
        description="its corner with the largest coordinates"
    )
    counts: Annotated[tuple[Count, Count, Count], Editable(Cost.RESTART)] = Field(
        (5, 5, 5), description="cells along x, y and z, 2 to 64 each and 4096 in all"
    )

    if TYPE_CHECKING:

        def __init__(
            self, *, min: Triple, max: Triple, counts: tuple[int, int, int] = (5, 5, 5)
        ) -> None: ...

    @model_validator(mode="after")
    def _holds_probes(self) -> Self:
        if any(low >= high for low, high in zip(self.min, self.max, strict=True)):
            raise ValueError("min must be below max along each axis")
        across, up, along = self.counts
        if across * up * along > MOST_PROBES:
            raise ValueError(f"counts are {across * up * along} probes in all, at most 4096")
        return self
