"""Check that texts use plain words: python tools/plain_words.py.

It reads pages, docstrings, comments, and the texts of glrt, and prints each finding.
"""

import ast
import io
import re
import sys
import tokenize
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).parents[1]
FOLDERS = ("docs", "glrt", "shaders_glsl", "bench", "tests", "tools")
READ = {".md", ".py", ".glsl", ".comp", ".frag", ".vert"}
INSTEAD = {  # expression: plain words
    r"(?i)\b(?:tells?|told|telling)\b": "report, say, show, distinguish",
    r"(?i)\bbeside\b": "with, next to, in addition to",
    r"(?i)\bin vain\b": "without result, unavailable",
    r"(?i)\banew\b": "again",
    r"(?i)\bbut for\b": "except",
    r"(?i)\bthose that\b": "a noun",
    r"(?i)\bof which\b": "a sentence of its own",
    r"(?i)\bwhat (?:it|they|he|she|each|one) (?:has|have)\b": "a noun",
    r"(?:^|(?<=[.!?:] ))(?:Of|Those|What)\b(?![^.!?]*\?)": "subject, verb, object",
}
RULES = {re.compile(rule, re.MULTILINE): advice for rule, advice in INSTEAD.items()}


class Finding(NamedTuple):
    """A word that is not plain."""

    file: str
    line: int
    words: str
    advice: str


def main() -> int:
    """Return 1 if any text holds a word that is not plain."""
    found = [finding for file in files() for finding in findings(file)]
    for finding in found:
        print(f"{finding.file}:{finding.line}: {finding.words!r}: {finding.advice}")
    return 1 if found else 0


def files() -> list[str]:
    """Pages, programs and shaders, relative to the root."""
    below = [path for name in FOLDERS for path in (ROOT / name).rglob("*")]
    found = [path for path in [*ROOT.glob("*.md"), *below] if path.suffix in READ]
    return sorted(str(path.relative_to(ROOT)) for path in found)


def findings(name: str) -> Iterator[Finding]:
    """Words of a file that are not plain, in the order of the rules."""
    text = (ROOT / name).read_text(encoding="utf-8")
    for line, prose in prose_of(name, text):
        for rule, advice in RULES.items():
            for match in rule.finditer(prose):
                yield Finding(name, line + prose.count("\n", 0, match.start()), match[0], advice)


def prose_of(name: str, text: str) -> Iterator[tuple[int, str]]:
    """Pieces of prose with the line on which each begins."""
    if name.endswith(".md"):
        bare = without_code(text)
        for block in re.finditer(r"(?:^(?!```|\||#)[^\n]+\n)+", bare, re.MULTILINE):
            yield bare.count("\n", 0, block.start()) + 1, block[0]
    elif not name.endswith(".py"):
        for comment in re.finditer(r"(?:^[ \t]*//[^\n]*\n)+|//[^\n]*", text, re.MULTILINE):
            bare = re.sub(r"^[ \t]*// ?", "", comment[0], flags=re.MULTILINE)
            yield text.count("\n", 0, comment.start()) + 1, bare
    else:
        yield from prose_of_python(text, is_product=name.startswith("glrt/"))


def without_code(page: str) -> str:
    """A page without its code and the targets of its links, line for line."""
    blank = re.sub(r"^```.*?^```", lambda m: "\n" * m[0].count("\n"), page, flags=re.M | re.S)
    blank = re.sub(r"\]\([^)\n]*\)", "]", blank)
    return re.sub(r"`[^`\n]*`", "`x`", blank)


def prose_of_python(text: str, is_product: bool) -> Iterator[tuple[int, str]]:
    """Docstrings and comments; of the product also its messages and help texts."""
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        if token.type == tokenize.COMMENT:
            yield token.start[0], token.string.lstrip("# ")
    tree = ast.parse(text)
    docstrings = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef) and node.body:
            first = node.body[0]
            if isinstance(first, ast.Expr) and isinstance(first.value, ast.Constant):
                docstrings.add(first.value)
    for node in ast.walk(tree):
        if not isinstance(node, ast.Constant) or not isinstance(node.value, str):
            continue
        if node in docstrings or (is_product and " " in node.value):
            yield node.lineno, node.value


if __name__ == "__main__":
    sys.exit(main())
