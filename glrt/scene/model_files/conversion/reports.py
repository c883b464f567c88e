"""Parts of a file that are left out, in words and by kind."""

from glrt.core.errors import ContentError
from glrt.core.text import quoted

_MOST_NAMED = 20  # of a kind


class UnshownError(ContentError):
    """A file cannot be shown; the message completes `FILE ...`, without a full stop."""


class LeftOut:
    """Parts of a file that are left out; each kind is reported once, with a number or names."""

    def __init__(self) -> None:
        self._counts: dict[str, int] = {}
        self._names: dict[str, dict[str, None]] = {}

    def add(self, kind: str, count: int = 1) -> None:
        """Count a part of a kind, such as `BasisCurves`."""
        self._counts[kind] = self._counts.get(kind, 0) + count

    def add_broken(self, count: int) -> None:
        """Count references that lead nowhere."""
        if count:
            self.add("references that lead nowhere", count)

    def name(self, kind: str, name: str) -> None:
        """Keep the name of a part of a kind, such as a layer that is missing."""
        self._names.setdefault(kind, {})[name] = None

    @property
    def told(self) -> list[str]:
        """All kinds in words, sorted."""
        found = [
            f"{kind} ({count:,} times)" if count > 1 else kind
            for kind, count in self._counts.items()
        ]
        for kind, names in self._names.items():
            listed = list(names)[:_MOST_NAMED]
            rest = len(names) - len(listed)
            more = f" and {rest:,} more" if rest else ""
            found.append(f"{kind} {', '.join(map(quoted, listed))}{more}")
        return sorted(found)
