"""The check of words: what it finds, where it looks, and when it fails."""

import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parents[2] / "tools"))

import plain_words

PYTHON = '''"""What a module has."""

def tell():
    """Those of a lamp."""
    return "the lamp beside it"  # told apart
'''


def found(name: str, text: str) -> list[str]:
    """The words that are found in a text."""
    pieces = [piece for _, piece in plain_words.prose_of(name, text)]
    return sorted(
        m[0] for piece in pieces for rule in plain_words.RULES for m in rule.finditer(piece)
    )


def test_docstrings_comments_and_messages_are_read_and_names_are_not() -> None:
    assert found("glrt/a.py", PYTHON) == ["Those", "What", "beside", "told"]
    assert found("tests/a.py", PYTHON) == ["Those", "What", "told"]


def test_pages_are_read_without_their_code() -> None:
    page = "# Told\n\nIt is built anew.\nOf three. What is it?\n\n```\ntell\n```\n\n`told`\n"
    assert found("a.md", page) == ["Of", "anew"]
    assert [line for line, _ in plain_words.prose_of("a.md", page)] == [3, 10]


def test_comments_of_shaders_are_read() -> None:
    assert found("shaders_glsl/a.glsl", "// in vain\nfloat told;  // but for one\n") == [
        "but for",
        "in vain",
    ]


@pytest.mark.parametrize(("text", "code"), [("It is told.\n", 1), ("[It](#told) is said.\n", 0)])
def test_a_page_passes_only_without_findings(
    text: str, code: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "docs").mkdir()
    (tmp_path / "docs" / "a.md").write_text(text)
    monkeypatch.setattr(plain_words, "ROOT", tmp_path)
    assert plain_words.main() == code
