"""Check that texts use plain words: python tools/plain_words.py.

It reads pages, docstrings, comments, and the texts of glrt. Each folder may hold at most as many
findings as tools/plain_words.csv allows. `--list FOLDER` prints them; `--lower` lowers the limits.
"""

import argparse
import ast
import csv
import io
import re
import sys
import tokenize
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).parents[1]
LIMITS = ROOT / "tools" / "plain_words.csv"
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


def main(arguments: list[str] | None = None) -> int:
    """Return 1 if a folder holds more findings than it may."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--list", metavar="FOLDER", help="print the findings below a folder")
    parser.add_argument("--lower", action="store_true", help="lower the limits to what is found")
    options = parser.parse_args(arguments)
    found = [finding for file in files() for finding in findings(file)]
    if options.list is not None:
        for finding in found:
            if finding.file.startswith(options.list):
                print(f"{finding.file}:{finding.line}: {finding.words!r}: {finding.advice}")
        return 0
    counts, limits = Counter(folder_of(finding.file) for finding in found), read_limits()
    if options.lower:
        write_limits({name: min(counts[name], limits.get(name, counts[name])) for name in counts})
        return 0
    above = [name for name in sorted(counts) if counts[name] > limits.get(name, 0)]
    for name in above:
        print(
            f"{name}: {counts[name]} words that are not plain, at most {limits.get(name, 0)}: "
            f"python tools/plain_words.py --list {name}"
        )
    unused = [name for name in sorted(limits) if counts[name] < limits[name]]
    for name in unused:
        print(f"{name}: {counts[name]} found, {limits[name]} allowed: run it with --lower")
    return 1 if above or unused else 0


def files() -> list[str]:
    """Pages, programs and shaders, relative to the root."""
    below = [path for name in FOLDERS for path in (ROOT / name).rglob("*")]
    found = [path for path in [*ROOT.glob("*.md"), *below] if path.suffix in READ]
    return sorted(str(path.relative_to(ROOT)) for path in found)


def folder_of(name: str) -> str:
    """The folder that the limits name: at most two levels."""
    parts = Path(name).parts[:-1]
    return "/".join(parts[:2]) or "."


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
    """A page whose code is blank, line for line."""
    blank = re.sub(r"^```.*?^```", lambda m: "\n" * m[0].count("\n"), page, flags=re.M | re.S)
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


def read_limits() -> dict[str, int]:
    """The most findings of each folder."""
    if not LIMITS.exists():
        return {}
    with LIMITS.open(newline="") as file:
        return {row["folder"]: int(row["most"]) for row in csv.DictReader(file)}


def write_limits(limits: dict[str, int]) -> None:
    """Write them, without folders that hold none."""
    with LIMITS.open("w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["folder", "most"])
        writer.writerows([name, limits[name]] for name in sorted(limits) if limits[name])


if __name__ == "__main__":
    sys.exit(main())
