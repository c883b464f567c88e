"""Nodes of the tree of a shader function: conditions, calls, and where each stands in its text."""

from typing import Literal, NamedTuple

# A single token; one call, whose arguments are pure; an expression in parentheses.
Kind = Literal["word", "call", "group", "other"]


class Leaf(NamedTuple):
    """An operand, or arithmetic with several: `x`, `a + f(b)`, `vec3(0.0)`."""

    start: int  # offsets in the text of the function
    end: int
    names: tuple[str, ...]  # outside of its parts
    parts: "tuple[Node, ...]"  # in brackets, or the two sides of an assignment
    is_pure: bool  # calls nothing and assigns nothing
    kind: Kind = "other"
    first: str = ""  # the first token


class Joined(NamedTuple):
    """Parts joined by `&&` or `||`, where the later parts may not run; a comparison; a negation."""

    start: int
    end: int
    sign: str
    parts: "tuple[Node, ...]"
    is_pure: bool


class Choice(NamedTuple):
    """`condition ? yes : no`."""

    start: int
    end: int
    condition: "Node"
    yes: "Node"
    no: "Node"
    is_pure: bool


Node = Leaf | Joined | Choice


class Simple(NamedTuple):
    """A statement without statements in it: an assignment, a declaration, a call, a jump."""

    start: int
    end: int
    jump: str | None  # return, break, continue or discard
    parts: tuple[Node, ...]


class Branch(NamedTuple):
    """`if (condition) then else other`."""

    start: int
    end: int
    condition: Node
    then: "Statement"
    other: "Statement | None"


class Loop(NamedTuple):
    """A `for` or a `while`."""

    start: int
    end: int
    head: tuple[Node, ...]
    body: "Statement"


class Block(NamedTuple):
    """Statements in braces."""

    start: int
    end: int
    statements: "tuple[Statement, ...]"


Statement = Simple | Branch | Loop | Block
