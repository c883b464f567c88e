"""The values of shader expressions that follow from constants alone."""

from collections.abc import Callable

from glrt.gpu.branch_nodes import Block, Branch, Joined, Leaf, Node, Simple, Statement
from glrt.gpu.branches import body_of

Value = bool | int | None  # None: not known before the shader runs


class ConstantValues:
    """The values of expressions that do not depend on anything but constants."""

    def __init__(self, texts_of: Callable[[str], list[str]]) -> None:
        """`texts_of` returns the texts of the functions of a name, without any for other names."""
        self._texts_of = texts_of
        self._known = dict[str, bool | int]()
        self._returned = dict[str, Value]()

    def learn(self, name: str, node: Node) -> None:
        """Learn a constant, if its value is known."""
        value = self.of(node)
        if value is not None:
            self._known[name] = value

    def decide(self, names: set[str]) -> bool:
        """Return whether one of some names is a constant, or a function of constants alone."""
        if not self._known.keys().isdisjoint(names):
            return True
        return any(self._of_function(name) is not None for name in names)

    def of(self, node: Node) -> Value:
        """Return the value of an expression; None if it is not known, or if it does more."""
        match node:
            case Leaf():
                return self._of_leaf(node)
            case Joined(sign="&&" | "||"):
                return self._of_logic(node)
            case Joined():
                return _related(node.sign, [self.of(part) for part in node.parts])
        chosen = self.of(node.condition)
        return None if chosen is None else self.of(node.yes if chosen else node.no)

    def _of_leaf(self, leaf: Leaf) -> Value:
        match leaf.kind:
            case "word":
                return self._known.get(leaf.first, _literal(leaf.first))
            case "call":
                return self._of_function(leaf.first)
            case "group":
                return self.of(leaf.parts[0])
        return None

    def _of_logic(self, node: Joined) -> Value:
        """Return the value of operands, unless one that is not known could do more."""
        ending, is_known = node.sign == "||", True
        for part in node.parts:
            value = self.of(part)
            if value is not None and bool(value) == ending:
                return ending
            if value is None and not part.is_pure:
                return None
            is_known = is_known and value is not None
        return not ending if is_known else None

    def _of_function(self, name: str) -> Value:
        """Return what a function returns for any arguments, if it does nothing else."""
        if name not in self._returned:
            self._returned[name] = None  # for a function that calls itself
            texts = self._texts_of(name)
            if len(texts) == 1 and "return" in texts[0]:
                self._returned[name] = self._of_body(body_of(texts[0]))
        return self._returned[name]

    def _of_body(self, statement: Statement | None) -> Value:
        match statement:
            case Block():
                for inner in statement.statements:
                    if not self._is_skipped(inner):
                        return self._of_body(inner)
            case Branch():
                value = self.of(statement.condition)
                chosen = statement.then if value else statement.other
                return None if value is None else self._of_body(chosen)
            case Simple(jump="return", parts=(returned,)):
                return self.of(returned)
        return None

    def _is_skipped(self, statement: Statement) -> bool:
        if not isinstance(statement, Branch) or statement.other is not None:
            return False
        return self.of(statement.condition) is False


def _literal(word: str) -> Value:
    if word.isdecimal():
        return int(word)
    return {"true": True, "false": False}.get(word)


def _related(sign: str, values: list[Value]) -> Value:
    """Return a negation of one value, or a comparison of two."""
    first, last = values[0], values[-1]
    if first is None or last is None:
        return None
    match sign:
        case "!":
            return not first
        case "==":
            return first == last
        case "!=":
            return first != last
        case "<":
            return first < last
        case ">":
            return first > last
        case "<=":
            return first <= last
    return first >= last
