"""Caches: of a property, and of the last results of a function for the same objects."""

from collections.abc import Callable
from functools import cached_property, wraps
from typing import TYPE_CHECKING, Any, TypeVar

Result = TypeVar("Result")

COUNT = 2  # results that are kept: while a scene is opened, two of them are asked for by turns


class ComputedOnce(cached_property[Any]):
    """A property that an object computes once, as `@computed_once`.

    In Python before 3.12, the one of functools lets threads wait while any object computes it. This
    one lets two threads compute the same value.
    """

    def __get__(self, instance: object, owner: type[Any] | None = None) -> Any:
        """Return the value of an object; the property itself for the class."""
        if instance is None:
            return self
        assert self.attrname
        known = instance.__dict__
        if self.attrname not in known:
            known[self.attrname] = self.func(instance)
        return known[self.attrname]


if TYPE_CHECKING:  # mypy knows that of functools
    computed_once = cached_property
else:
    computed_once = ComputedOnce


def kept_for_the_same(function: Callable[..., Result]) -> Callable[..., Result]:
    """Decorate a function to reuse its COUNT last results where its arguments are the same objects.

    Comparing scenes by their values would take as long as the work that it saves.
    """
    known: tuple[tuple[tuple[object, ...], Result], ...] = ()

    @wraps(function)
    def remembered(*given: object) -> Result:
        nonlocal known
        last = known  # another thread may replace it at any moment
        for arguments, result in last:
            if len(arguments) == len(given) and all(map(_is_same, arguments, given)):
                return result
        made = function(*given)
        known = ((given, made), *last)[:COUNT]
        return made

    return remembered


def _is_same(known: object, given: object) -> bool:
    return known is given
