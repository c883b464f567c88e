"""Leave out shader code that constants rule out, before the driver reads it.

A kernel holds the code of all features, and its constants say which are in use. A driver drops the
others too, but only after it has parsed and checked them, which takes as long as the rest.

Three things are left out: branches and operands that the constants rule out, statements behind a
jump, and functions that nothing calls then. Text that is not understood stays as it is.
"""

import re
from collections.abc import Iterable, Iterator, Sequence
from typing import NamedTuple

from glrt.gpu.branch_nodes import Block, Branch, Choice, Joined, Leaf, Loop, Node, Simple, Statement
from glrt.gpu.branches import body_of, expression_of
from glrt.gpu.constant_values import ConstantValues

_FUNCTION = re.compile(r"[A-Za-z_]\w*(?:\[\w*\])? (\w+)\(")
_CONSTANT = re.compile(r"const (?:bool|int) (\w+) = ([^;]+);")
_NAME = re.compile(r"[A-Za-z_]\w*")
_COMMENT = re.compile(r"//[^\n]*")
_ENTRY = "main"


class _Cut(NamedTuple):
    """A span of the text of a function that is left out, and what stands in its place."""

    start: int
    end: int
    instead: str = ""


class _Chunk(NamedTuple):
    """Lines of a shader: a function, or what stands between functions."""

    name: str | None  # of the function
    first: int
    end: int  # the line behind the last


def live_lines(lines: Sequence[str]) -> list[tuple[int, str]]:
    """Return the lines of a shader that can run, each with its place among those given.

    All lines are returned if one is no GLSL that is understood here: the driver says better what is
    wrong with it.
    """
    try:
        return [*_Shader(lines).live()]
    except (IndexError, ValueError):
        return [*enumerate(lines)]


class _Shader:
    """The functions of a shader; the entry reaches some of them."""

    def __init__(self, lines: Sequence[str]) -> None:
        self._lines = lines
        self._chunks = [*_chunks(lines)]
        self._functions = dict[str, list[_Chunk]]()
        for chunk in self._chunks:
            if chunk.name:
                self._functions.setdefault(chunk.name, []).append(chunk)
        self.values = ConstantValues(self._texts_of)
        self._reached = set[str]()
        self._waiting = list[str]()

    def live(self) -> Iterator[tuple[int, str]]:
        """Yield the lines that can run, each with its place."""
        self._read_declarations()
        if _ENTRY not in self._functions:
            raise ValueError("there is no entry")
        self.use((_ENTRY,))
        cuts = dict[_Chunk, list[_Cut]]()
        while self._waiting:
            for chunk in self._functions[self._waiting.pop()]:
                cuts[chunk] = self._cuts(self._text(chunk))
        for chunk in self._chunks:
            if chunk.name is None:
                yield from enumerate(self._lines[chunk.first : chunk.end], chunk.first)
            elif chunk in cuts:
                yield from self._without(chunk, cuts[chunk])

    def use(self, names: Iterable[str]) -> None:
        """Reach the functions among some names."""
        for name in names:
            if name in self._functions and name not in self._reached:
                self._reached.add(name)
                self._waiting.append(name)

    def _read_declarations(self) -> None:
        """Learn the values of global constants, and which functions declarations call."""
        for chunk in self._chunks:
            for line in self._lines[chunk.first : chunk.end] if chunk.name is None else ():
                if found := _CONSTANT.match(line):
                    self.values.learn(found[1], expression_of(found[2]))
                if "(" in line:
                    self.use(_NAME.findall(_COMMENT.sub("", line)))

    def _texts_of(self, name: str) -> list[str]:
        return [self._text(chunk) for chunk in self._functions.get(name, ())]

    def _text(self, chunk: _Chunk) -> str:
        return "\n".join(self._lines[chunk.first : chunk.end])

    def _cuts(self, text: str) -> list[_Cut]:
        """Return what never runs of a function, in order, and reach what the rest calls."""
        names = set(_NAME.findall(_COMMENT.sub("", text)))
        if not self.values.decide(names):
            self.use(names)
            return []
        walk = _Walk(self)
        walk.statement(body_of(text))
        return walk.cuts

    def _without(self, chunk: _Chunk, cuts: Sequence[_Cut]) -> Iterator[tuple[int, str]]:
        """Yield the lines of a function without what is cut, nor lines that it leaves blank."""
        start = at = 0
        waiting = [*reversed(cuts)]
        for number in range(chunk.first, chunk.end):
            line = self._lines[number]
            end, at, kept = start + len(line), max(at, start), list[str]()
            while at <= end and waiting and waiting[-1].start <= end:
                cut = waiting.pop()
                kept += line[at - start : cut.start - start], cut.instead
                at = cut.end
            if at <= end:
                kept.append(line[at - start :])
            text = "".join(kept)
            if text.strip() or text == line:
                yield number, text
            start = end + 1


class _Walk:
    """A way through all of a function that can run; notes what cannot."""

    def __init__(self, shader: _Shader) -> None:
        self.cuts = list[_Cut]()
        self._shader, self._values = shader, shader.values

    def statement(self, node: Statement, *, is_alone: bool = True) -> None:
        """Walk through a statement; one that is alone belongs to a branch or a loop."""
        match node:
            case Simple():
                self._all(node.parts)
            case Loop():
                self._all(node.head)
                self.statement(node.body)
            case Block():
                self._block(node)
            case Branch():
                self._branch(node, is_alone)

    def _block(self, block: Block) -> None:
        for number, inner in enumerate(block.statements):
            self.statement(inner, is_alone=False)
            if self._ends(inner) and number + 1 < len(block.statements):
                self._cut(block.statements[number + 1].start, block.statements[-1].end)
                return

    def _branch(self, node: Branch, is_alone: bool) -> None:
        value = self._values.of(node.condition)
        if value is None:
            self._expression(node.condition)
            self.statement(node.then)
            if node.other:
                self.statement(node.other)
        elif chosen := node.then if value else node.other:
            self._cut(node.start, chosen.start)
            self.statement(chosen, is_alone=is_alone)
            self._cut(chosen.end, node.end)
        else:
            self._cut(node.start, node.end, ";" if is_alone else "")

    def _ends(self, statement: Statement | None) -> bool:
        """Return whether no statement behind this one can run."""
        match statement:
            case Simple():
                return statement.jump is not None
            case Block():
                return any(map(self._ends, statement.statements))
            case Branch():
                value = self._values.of(statement.condition)
                if value is None:
                    return self._ends(statement.then) and self._ends(statement.other)
                return self._ends(statement.then if value else statement.other)
        return False

    def _all(self, nodes: Iterable[Node]) -> None:
        for node in nodes:
            self._expression(node)

    def _expression(self, node: Node) -> None:
        match node:
            case Leaf():
                self._shader.use(node.names)
                self._all(node.parts)
            case Joined(sign="&&" | "||"):
                self._logic(node)
            case Joined():
                self._all(node.parts)
            case Choice():
                self._choice(node)

    def _logic(self, node: Joined) -> None:
        """Walk through operands up to the first that decides."""
        for part in node.parts:
            self._expression(part)
            value = self._values.of(part)
            if value is not None and bool(value) == (node.sign == "||"):
                self._cut(part.end, node.end)
                return

    def _choice(self, node: Choice) -> None:
        value = self._values.of(node.condition)
        if value is None:
            self._all((node.condition, node.yes, node.no))
        elif value:
            self._cut(node.start, node.yes.start)
            self._expression(node.yes)
            self._cut(node.yes.end, node.end)
        else:
            self._cut(node.start, node.no.start)
            self._expression(node.no)

    def _cut(self, start: int, end: int, instead: str = "") -> None:
        if end > start:
            self.cuts.append(_Cut(start, end, instead))


def _chunks(lines: Sequence[str]) -> Iterator[_Chunk]:
    """Yield functions, which begin in column 0, and the lines between them."""
    first = place = 0
    while place < len(lines):
        found = _FUNCTION.match(lines[place])
        end = _end_of_function(lines, place) if found else None
        if found and end:
            if place > first:
                yield _Chunk(None, first, place)
            yield _Chunk(found[1], place, end)
            first = place = end
        else:
            place += 1
    if place > first:
        yield _Chunk(None, first, place)


def _end_of_function(lines: Sequence[str], first: int) -> int | None:
    """Return the line behind a function; None for one that is only declared."""
    depth = 0
    for place in range(first, len(lines)):
        code = lines[place].partition("//")[0]
        if code == "}":
            return place + 1
        depth += code.count("{") - code.count("}")
        if not depth and "{" in code:
            return place + 1
        if not depth and code.rstrip().endswith(";"):
            return None
    raise ValueError("a function has no end")
