"""Rows of the table of features: when a kernel needs each, and how users read about it."""

from collections.abc import Callable
from dataclasses import field
from typing import Any, NamedTuple

from glrt.plan import reasons
from glrt.plan.case import Case
from glrt.plan.facts import SceneFacts
from glrt.plan.lobes import LobeFacts
from glrt.plan.reasons import Reason


class Row(NamedTuple):
    """A field of `Needs` in glrt.plan.features, which `row` and the functions after it declare."""

    when: Callable[[Case], Any]  # its value
    name: str  # for users; empty for what other rows explain
    why: Reason
    shown: Callable[[Any], bool] | None  # whether users see it as compiled in
    most: bool | int  # its value in a kernel with every feature


def row(
    when: Callable[[Case], Any],
    name: str = "",
    why: Reason = reasons.by_method,
    shown: Callable[[Any], bool] | None = None,
    most: bool | int = True,
) -> Any:
    """Return a field of `Needs`; with `when` alone, it is part of what other rows explain."""
    return field(metadata={"row": Row(when, name, why, shown, most)})


def texture(name: str, *keys: str) -> Any:
    """Return the row of textures of some material keys."""
    return row(lambda it: bool(it.facts.mapped & {*keys}), name, reasons.textured(*keys))


def lobe(kind: str, name: str, names: Callable[[LobeFacts], list[str]]) -> Any:
    """Return the row of a kind of material, found by the names of such materials."""
    why = reasons.made_of(kind, lambda it: names(it.facts.lobes))
    return row(lambda it: bool(names(it.facts.lobes)), name, why)


def glass(
    kind: str, name: str, names: Callable[[SceneFacts], list[str]], is_rough: bool = False
) -> Any:
    """Return the row of a kind of glass that not every method follows, or shows as rough."""
    why = reasons.made_of(kind, lambda it: names(it.facts))

    def when(case: Case) -> bool:
        is_seen = case.traits.follows and (case.traits.has_rough or not is_rough)
        return is_seen and bool(names(case.facts))

    return row(when, name, why)
