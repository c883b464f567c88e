"""The range and the cost of an edit, as fields of models declare them."""

from dataclasses import dataclass
from enum import StrEnum

from pydantic import BaseModel, ConfigDict
from pydantic.fields import FieldInfo


class Cost(StrEnum):
    """The effect of a changed setting on a running render."""

    FREE = "free"  # only the display changes
    RELIGHT = "relight"  # weights of film layers change: no sample is lost
    RESTART = "restart"  # accumulation starts again
    RECOMPILE = "recompile"  # another kernel is compiled


@dataclass(frozen=True)
class Editable:
    """Data that a widget needs for a field in addition to its limits, stored in the annotation."""

    cost: Cost = Cost.RESTART  # effect of an edit
    unit: str = ""
    slider: tuple[float, float] | None = None  # a useful range for dragging


def editable_of(field: FieldInfo) -> Editable:
    """Return the Editable in the annotation of a model's field, or a default one."""
    return next((part for part in field.metadata if isinstance(part, Editable)), Editable())


class Frozen(BaseModel):
    """An immutable value that rejects unknown keys, infinities and NaN."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)
