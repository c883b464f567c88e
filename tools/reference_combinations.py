"""The page of what goes with what, from the table that refuses the rest."""

from collections.abc import Iterator

from reference_markdown import GENERATED, table

from glrt.plan.combinations import MEANINGS, Way, pairs, reason, works


def combinations_page() -> Iterator[str]:
    """Every way to render, every cell, and why some are refused."""
    yield "# What goes with what"
    yield GENERATED
    yield (
        "Ways to render that can be asked for together. A refused combination ends with exit code "
        "2 and its reason before anything compiles. A test tries each cell."
    )
    yield table(("way", "is"), [(name(way), MEANINGS[way]) for way in Way])
    yield "✓: they work together; no: refused, see below."
    rows = [(name(way), *(cell(way, other) for other in Way)) for way in Way]
    yield table(("", *map(name, Way)), rows)
    yield "## Why"
    refused = [pair for pair in pairs() if not works(*pair)]
    reasons = [(f"{name(one)} and {name(other)}", reason(one, other)) for one, other in refused]
    yield table(("refused", "reason"), reasons)


def name(way: Way) -> str:
    """A way as the page calls it."""
    return f"`{way}`" if way.startswith("--") else str(way)


def cell(one: Way, other: Way) -> str:
    """A cell of the table; empty on its diagonal."""
    return "" if one is other else "✓" if works(one, other) else "no"
