"""Scenes with faults: tables with a wrong value somewhere, files with wrong bytes somewhere."""

from collections.abc import Iterator
from copy import deepcopy
from typing import Any

from hypothesis import strategies as st

from glrt.core.resources import folder
from tests.fuzz.grammar import Table, scenes

JUNK = st.one_of(
    st.sampled_from(
        [True, "", "nan", "white", [], {}, [[]], [1], [1, 2, 3, 4], 1e300, -1, 2**70, "\x00\x1b"]
    ),
    st.floats(),
    st.integers(),
    st.text(max_size=12),
    st.recursive(st.booleans(), lambda inner: st.lists(inner, max_size=3), max_leaves=20),
)
Place = tuple[dict[Any, Any] | list[Any], Any]


def places(value: Any) -> Iterator[Place]:
    """Every container of the tables with every key of it."""
    items = value.items() if isinstance(value, dict) else enumerate(value)
    for key, inner in items:
        yield value, key
        if isinstance(inner, dict | list):
            yield from places(inner)


@st.composite
def broken_scenes(draw: st.DrawFn) -> Table:
    """A scene by the grammar, with one to three values replaced, dropped or misnamed."""
    table = draw(scenes())
    for _ in range(draw(st.integers(1, 3))):
        if not table:
            break
        owner, key = draw(st.sampled_from(list(places(table))))
        change = draw(st.sampled_from(["replace", "replace", "drop", "rename"]))
        if change == "replace":
            owner[key] = deepcopy(draw(JUNK))  # a later change must not reach the samples
        elif change == "drop":
            del owner[key]
        elif isinstance(owner, dict):
            owner[draw(st.text(max_size=8))] = owner.pop(key)
    return table


FILES = sorted(
    path.read_bytes() for path in folder("scenes").glob("*.toml") if path.stat().st_size < 10_000
)
SYNTAX = b"[ ] [[ = \" ''' \x00 \xff \r # { 1e999 nan -inf 0x 1_ a.b.c=1 \xef\xbb\xbf".split(b" ")
TOKENS = st.sampled_from([*SYNTAX, b"[render]\n", b"9" * 5000, b"[" * 2000])


@st.composite
def broken_files(draw: st.DrawFn) -> bytes:
    """A scene file of glrt's own, with one to four pieces cut, doubled or put in."""
    text = draw(st.sampled_from(FILES))
    for _ in range(draw(st.integers(1, 4))):
        start = draw(st.integers(0, len(text)))
        end = min(len(text), start + draw(st.integers(0, 40)))
        piece = draw(
            st.one_of(TOKENS, st.just(b""), st.just(text[start:end] * 2), st.binary(max_size=4))
        )
        text = text[:start] + piece + text[end:]
    return text
