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


@pytest.mark.parametrize(("most", "code"), [(1, 1), (2, 0), (3, 1)])
def test_a_folder_holds_as_many_as_its_limit_says(
    most: int, code: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "docs").mkdir()
    (tmp_path / "docs" / "a.md").write_text("It is told. It is built anew.\n")
    monkeypatch.setattr(plain_words, "ROOT", tmp_path)
    monkeypatch.setattr(plain_words, "LIMITS", tmp_path / "limits.csv")
    plain_words.write_limits({"docs": most})
    assert plain_words.main([]) == code
    assert plain_words.main(["--lower"]) == 0
    assert plain_words.read_limits() == {"docs": min(most, 2)}
