"""Descriptions of editable values, read from the models: range, unit, help and cost.

Nothing here draws. A field of a model declares all of this once; see `glrt.settings` and
the models in `glrt.scene`.
"""

import types
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Annotated, Any, Literal, TypeVar, Union, get_args, get_origin

from pydantic import BaseModel, ValidationError
from pydantic.fields import FieldInfo

from glrt.core.errors import UsageError
from glrt.settings import Cost, editable_of

Model = TypeVar("Model", bound=BaseModel)
Kind = Literal["integer", "number", "choice", "switch", "color", "vector"]

MEANING = {
    Cost.FREE: "changes only the display; no sample is lost",
    Cost.RELIGHT: "reweights the accumulated light; no sample is lost",
    Cost.RESTART: "restarts the picture",
    Cost.RECOMPILE: "compiles another kernel and restarts the picture",
}


@dataclass(frozen=True)
class Control:
    """An editable value; `low` and `high` are its range, `slider` is the useful part of it."""

    name: str
    kind: Kind
    help: str
    cost: Cost
    unit: str = ""
    low: float | None = None
    high: float | None = None
    slider: tuple[float, float] | None = None
    choices: tuple[Any, ...] = ()
    default: Any = None  # a double click sets it; None if there is none
    is_of_scene: bool = False  # whether `default` is the value of the scene as it was opened
    told: tuple[str, ...] = ()  # explanation of each choice; empty if the words suffice
    reach: tuple[float, Cost] | None = None  # largest value of this cost, and the cost beyond it

    @property
    def label(self) -> str:
        """Name in words: blanks in place of underscores."""
        return self.name.replace("_", " ")

    def named(self, name: str) -> "Control":
        """Return the same control with another name."""
        return replace(self, name=name)

    def costing(self, cost: Cost, reach: tuple[float, Cost] | None = None) -> "Control":
        """Return the same control with the cost that an edit has at present."""
        return replace(self, cost=cost, reach=reach)

    def back_to(self, value: Any) -> "Control":
        """Return the same control with the value of the scene as its default; None keeps it."""
        if value is None or self.kind == "switch":
            return self
        return replace(self, default=value, is_of_scene=True)

    @property
    def costs(self) -> tuple[tuple[Cost, str], ...]:
        """Costs of an edit, each with the values that it applies to; "" for all values."""
        if not self.reach or (self.high is not None and self.high <= self.reach[0]):
            return ((self.cost, ""),)
        return (self.cost, f"up to {self.reach[0]:g}"), (self.reach[1], "above")

    @property
    def is_logarithmic(self) -> bool:
        """Whether the slider is logarithmic: its ends are positive and differ by over 100 times."""
        low, high = self.slider or (0, 0)
        return low > 0 and high / low > 100


def controls_of(model: type[BaseModel], leave_out: tuple[str, ...] = ()) -> tuple[Control, ...]:
    """Return a control for each field of a model that a widget can edit, in its order."""
    fields = ((n, f) for n, f in model.model_fields.items() if n not in leave_out)
    return tuple(control for name, field in fields if (control := _control(name, field)))


def control_of_items(model: type[BaseModel], field: str) -> Control:
    """Return the control for one of the values of a field that maps names to values."""
    whole = model.model_fields[field]
    item = FieldInfo.from_annotation(get_args(whole.annotation)[1])
    item.description = whole.description
    item.metadata = [*item.metadata, editable_of(whole)]
    control = _control(field, item)
    assert control
    return control


def switch(name: str, help_text: str, cost: Cost) -> Control:
    """Return a control for an on-off value that is not a field of a model."""
    return Control(name, "switch", help_text, cost)


def choice(name: str, help_text: str, cost: Cost, choices: tuple[str, ...] = ()) -> Control:
    """Return a control for one of several words that is not a field of a model."""
    return Control(name, "choice", help_text, cost, choices=choices)


def replaced(value: Model, **changes: Any) -> Model:
    """Return a copy of a frozen model with changed fields; UsageError for an invalid value."""
    return made(type(value), {**dict(value), **changes})


def made(model: type[Model], values: Mapping[str, Any]) -> Model:
    """Return a frozen model of these values; UsageError for an invalid value."""
    try:
        return model.model_validate(values)
    except ValidationError as error:
        problem = error.errors(include_url=False, include_input=False)[0]
        text = str(problem["msg"]).removeprefix("Value error, ")
        place = ".".join(str(part) for part in problem["loc"])
        raise UsageError(f"{place}: {text}" if place else text) from None


def _control(name: str, field: FieldInfo) -> Control | None:
    plain, limits = _unwrapped(field.annotation, list(field.metadata))
    kind = _kind(plain)
    if kind is None:
        return None
    declared = editable_of(field)
    if kind == "color":
        limits = _unwrapped(get_args(plain)[0], [])[1]
    low, high = _bound(limits, "ge", "gt"), _bound(limits, "le", "lt")
    slider = declared.slider
    return Control(
        name,
        kind,
        field.description or "",
        declared.cost,
        declared.unit,
        low,
        high,
        slider or (None if low is None or high is None or high > 1e6 else (low, high)),
        get_args(plain) if kind == "choice" else (),
        None if field.is_required() or kind == "switch" else field.default,
    )


def _unwrapped(annotation: Any, limits: list[Any]) -> tuple[Any, list[Any]]:
    """Return the plain type below Annotated and Optional, and all limits found on the way."""
    if get_origin(annotation) is Annotated:
        plain, *more = get_args(annotation)
        inner = [part for item in more for part in _limits(item)]
        return _unwrapped(plain, limits + inner)
    if get_origin(annotation) in (Union, types.UnionType):
        rest = [part for part in get_args(annotation) if part is not type(None)]
        if len(rest) == 1:
            return _unwrapped(rest[0], limits)
    return annotation, limits


def _limits(item: Any) -> Iterator[Any]:
    if isinstance(item, FieldInfo):
        yield from item.metadata
    else:
        yield item


def _kind(plain: Any) -> Kind | None:
    kinds: dict[Any, Kind] = {bool: "switch", int: "integer", float: "number"}
    if plain in kinds:
        return kinds[plain]
    parts = get_args(plain)
    if get_origin(plain) is Literal and len(parts) > 1:
        return "choice"
    if get_origin(plain) is tuple and len(parts) == 3:
        low = _bound(_unwrapped(parts[0], [])[1], "ge", "gt")
        return "color" if low == 0 else "vector"
    return None


def _bound(limits: list[Any], *names: str) -> float | None:
    found = [getattr(item, name) for item in limits for name in names if hasattr(item, name)]
    return float(found[0]) if found else None
