"""Parse a shader function into a tree of its branches.

The tree holds no more than what decides which code can run. Arithmetic is a `Leaf` with the names
in it.
"""

import re
from functools import lru_cache

from glrt.gpu.branch_nodes import (
    Block,
    Branch,
    Choice,
    Joined,
    Kind,
    Leaf,
    Loop,
    Node,
    Simple,
    Statement,
)

_TOKEN = re.compile(
    r"//[^\n]*|[A-Za-z_]\w*|\.?\d(?:[eE][-+]|[\w.])*|&&|\|\||\+\+|--|<<=?|>>=?|[-+*/%&|^=!<>]=|\S"
)
_RELATIONS = ("==", "!=", "<", ">", "<=", ">=")
_ASSIGNMENTS = ("=", "+=", "-=", "*=", "/=", "%=", "&=", "|=", "^=", "<<=", ">>=")
_CLOSING = {"(": ")", "[": "]", "{": "}"}
_CONDITIONS = ("?", "&&", "||", "{", "}")
_JUMPS = ("return", "break", "continue", "discard")
_STEPS = ("++", "--")


@lru_cache(maxsize=2048)
def body_of(text: str) -> Block:
    """Return the body of a function; ValueError or IndexError if the text is not understood."""
    parser = _Parser(text)
    parser.skip_to("{")
    return parser.block()


@lru_cache(maxsize=512)
def expression_of(text: str) -> Node:
    """Return an expression; ValueError or IndexError if the text is not understood."""
    return _Parser(text + ";").choice()


class _Parser:
    """A place in the tokens of a text."""

    def __init__(self, text: str) -> None:
        found = (match for match in _TOKEN.finditer(text) if not match[0].startswith("//"))
        self._tokens = [(match[0], match.start(), match.end()) for match in found]
        self._at = 0

    @property
    def _next(self) -> str:
        return self._tokens[self._at][0]

    @property
    def _start(self) -> int:
        return self._tokens[self._at][1]

    @property
    def _end(self) -> int:
        """The end of the token before."""
        return self._tokens[self._at - 1][2]

    def _take(self, wanted: str) -> None:
        if self._next != wanted:
            raise ValueError(f"{wanted} is missing")
        self._at += 1

    def skip_to(self, token: str) -> None:
        """Go on to the next token of a kind."""
        while self._next != token:
            self._at += 1

    # --- statements ----------------------------------------------------------------------------

    def block(self) -> Block:
        """Return the block that begins here."""
        start = self._start
        self._take("{")
        statements = list[Statement]()
        while self._next != "}":
            statements.append(self._statement())
        self._take("}")
        return Block(start, self._end, tuple(statements))

    def _statement(self) -> Statement:
        start = self._start
        match self._next:
            case "{":
                return self.block()
            case "if":
                return self._branch(start)
            case "for" | "while" as word:
                self._take(word)
                head, body = self._brackets("("), self._statement()
                return Loop(start, self._end, head, body)
            case "do" | "switch" | "case" | "default":
                raise ValueError(f"{self._next} is not understood")
        jump = self._next if self._next in _JUMPS else None
        if jump is None and (names := self._plain_names()):
            return Simple(start, self._end, None, (Leaf(start, self._end, names, (), False),))
        self._at += jump is not None
        parts = self._list(";")
        return Simple(start, self._end, jump, parts)

    def _plain_names(self) -> tuple[str, ...]:
        """Pass a statement without conditions, and return its names; else stay, without names."""
        names = list[str]()
        for place in range(self._at, len(self._tokens)):
            token = self._tokens[place][0]
            if token == ";":
                self._at = place + 1
                return tuple(names)
            if token in _CONDITIONS:
                break
            if token[0].isalpha() or token[0] == "_":
                names.append(token)
        return ()

    def _branch(self, start: int) -> Branch:
        self._take("if")
        self._take("(")
        condition = self.choice()
        self._take(")")
        then, other = self._statement(), None
        if self._next == "else":
            self._take("else")
            other = self._statement()
        return Branch(start, self._end, condition, then, other)

    # --- expressions ---------------------------------------------------------------------------

    def _brackets(self, opening: str) -> tuple[Node, ...]:
        self._take(opening)
        return self._list(_CLOSING[opening])

    def _list(self, closing: str) -> tuple[Node, ...]:
        """Return expressions up to a token, and pass it."""
        found = list[Node]()
        while self._next != closing:
            if self._next in (",", ";"):
                self._at += 1
            else:
                found.append(self._assignment())
        self._take(closing)
        return tuple(found)

    def _assignment(self) -> Node:
        left = self.choice()
        if self._next not in _ASSIGNMENTS:
            return left
        self._at += 1
        right = self._assignment()
        return Leaf(left.start, self._end, (), (left, right), is_pure=False)

    def choice(self) -> Node:
        """Return an expression without assignment."""
        condition = self._logic("||")
        if self._next != "?":
            return condition
        self._take("?")
        yes = self._assignment()
        self._take(":")
        no = self._assignment()
        is_pure = condition.is_pure and yes.is_pure and no.is_pure
        return Choice(condition.start, self._end, condition, yes, no, is_pure)

    def _logic(self, sign: str) -> Node:
        part = self._relation if sign == "&&" else lambda: self._logic("&&")
        parts = [part()]
        while self._next == sign:
            self._at += 1
            parts.append(part())
        if len(parts) == 1:
            return parts[0]
        is_pure = all(node.is_pure for node in parts)
        return Joined(parts[0].start, self._end, sign, tuple(parts), is_pure)

    def _relation(self) -> Node:
        node = self._negation()
        while self._next in _RELATIONS:
            sign = self._next
            self._at += 1
            right = self._negation()
            is_pure = node.is_pure and right.is_pure
            node = Joined(node.start, self._end, sign, (node, right), is_pure)
        return node

    def _negation(self) -> Node:
        start = self._start
        if self._next != "!":
            return self._operand()
        self._take("!")
        node = self._negation()
        return Joined(start, self._end, "!", (node,), node.is_pure)

    def _operand(self) -> Node:
        """Return what stands up to the next operator of another kind than arithmetic."""
        start, first = self._start, self._at
        names, parts, calls = list[str](), list[Node](), list[str]()
        is_pure, before = True, ""
        while True:
            token = self._next
            if token in ("(", "[", "{"):
                inner = self._brackets(token)
                parts += inner
                if token == "(" and (before[:1].isalpha() or before[:1] == "_" or before == "]"):
                    is_pure = False
                    calls.append(before)
                before = _CLOSING[token]
            elif token[0].isalnum() or token[0] in "_.+-*/%~&^|!" or token in ("<<", ">>"):
                if token[-1] == "=" or token in ("&&", "||"):
                    break
                is_pure = is_pure and token not in _STEPS
                if token[0].isalpha() or token[0] == "_":
                    names.append(token)
                before = token
                self._at += 1
            else:
                break
        if self._at == first:
            raise ValueError(f"{self._next} is not understood")
        of_parts = all(part.is_pure for part in parts)
        kind = self._kind(first, len(parts), len(calls), of_parts)
        found = tuple(names), tuple(parts), is_pure and of_parts
        return Leaf(start, self._end, *found, kind, self._tokens[first][0])

    def _kind(self, first: int, parts: int, calls: int, is_pure: bool) -> Kind:
        """Return the kind of the operand that ends here, by its first token."""
        if self._at == first + 1:
            return "word"
        if parts == 1 and self._is_one_group(first):
            return "group"
        return "call" if calls == 1 and is_pure and self._is_one_group(first + 1) else "other"

    def _is_one_group(self, first: int) -> bool:
        """Return whether the tokens from one on are parentheses with all that is in them."""
        depth = 0
        for place in range(first, self._at):
            token = self._tokens[place][0]
            depth += (token in "([{") - (token in ")]}")
            if depth == 0:
                return token == ")" and place == self._at - 1
        return False
