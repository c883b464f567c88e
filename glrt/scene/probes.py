"""The grid of probes that a scene may give."""

from typing import TYPE_CHECKING, Annotated, Self

from pydantic import Field, model_validator

from glrt.scene.values import Number, Triple, Value, Vector
from glrt.settings import Cost, Editable

MOST_PROBES = 4096  # in a grid
Count = Annotated[int, Field(ge=2, le=64)]


class Probes(Value):
    """A box of equal cells, with a probe in the middle of each, and how live probes are updated."""

    min: Annotated[Vector | None, Editable(Cost.RESTART)] = Field(
        None,
        description="its corner with the least coordinates, given together with `max`; default: "
        "around what is seen",
    )
    max: Annotated[Vector | None, Editable(Cost.RESTART)] = Field(
        None, description="its corner with the largest coordinates"
    )
    counts: Annotated[tuple[Count, Count, Count], Editable(Cost.RESTART)] = Field(
        (5, 5, 5), description="cells along x, y and z, 2 to 64 each and 4096 in all"
    )
    per_update: Annotated[float, Editable(Cost.RESTART, "", (0.05, 1))] = Field(
        1.0,
        description="share of the probes that a picture of live probes updates, in turn: above 0, "
        "at most 1; a picture at rest updates all",
        gt=0,
        le=1,
    )

    if TYPE_CHECKING:

        def __init__(
            self,
            *,
            min: Triple | None = None,
            max: Triple | None = None,
            counts: tuple[int, int, int] = (5, 5, 5),
            per_update: Number = 1.0,
        ) -> None: ...

    @model_validator(mode="after")
    def _holds_probes(self) -> Self:
        if (self.min is None) != (self.max is None):
            raise ValueError("min and max go together; give both, or neither")
        if any(low >= high for low, high in zip(self.min or (), self.max or (), strict=True)):
            raise ValueError("min must be below max along each axis")
        across, up, along = self.counts
        if across * up * along > MOST_PROBES:
            raise ValueError(f"counts are {across * up * along} probes in all, at most 4096")
        return self

    @property
    def box(self) -> tuple[Vector, Vector] | None:
        """Its corners; None if it is to lie around what is seen."""
        return (self.min, self.max) if self.min is not None and self.max is not None else None
