"""Explain in words why each kernel feature is compiled in or left out."""

from collections.abc import Iterator
from typing import NamedTuple

from glrt.core.text import counted, plural
from glrt.plan import reasons
from glrt.plan.case import Case
from glrt.plan.features import ROWS, WITHOUT_OWN_FLAG, Needs
from glrt.plan.plan import Plan
from glrt.scene.materials.kinds import TYPES
from glrt.scene.shapes.kinds import KINDS, SAMPLED

_SORT = {"none": "material of type none"}
_SPOKEN = {"dielectric": "glass", "none": "no surface"}


class Feature(NamedTuple):
    """A feature of the kernel, whether it is compiled in, and why."""

    name: str
    present: bool
    reason: str


def explain(plan: Plan) -> list[Feature]:
    """List every kernel feature: whether it is compiled in, and what in the scene decides that."""
    case, needs = Case(plan.facts, plan.settings), plan.needs
    found: list[Feature] = []
    for name, row in ROWS.items():
        if name in _OF_SETS:
            found += _OF_SETS[name](case, needs)
        elif row.name:
            present = row.shown(needs) if row.shown else bool(getattr(needs, name))
            found.append(Feature(row.name, present, row.why(case)))
    return found


def _shapes(case: Case, needs: Needs) -> Iterator[Feature]:
    for kind in KINDS:
        yield Feature(plural(kind), kind in needs.shapes, counted(case.facts.shapes[kind], kind))


def _materials(case: Case, needs: Needs) -> Iterator[Feature]:
    for kind in TYPES:
        if kind not in WITHOUT_OWN_FLAG:
            named = [name for name, it in case.facts.materials.items() if it.type == kind]
            reason = reasons.listed(named, _SORT.get(kind, f"{kind} material"))
            yield Feature(_SPOKEN.get(kind, kind), kind in needs.materials, reason)


def _lamps(case: Case, needs: Needs) -> Iterator[Feature]:
    for kind in SAMPLED:
        yield Feature(f"{kind} lamps", kind in needs.lamps, reasons.by_method_and_lamps(case))


_OF_SETS = {"shapes": _shapes, "materials": _materials, "lamps": _lamps}
