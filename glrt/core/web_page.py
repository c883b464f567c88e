"""Pages that need no network: one HTML file each, with a common style, dark and light."""

import json
from html import escape
from importlib.resources import files as resources
from pathlib import Path
from typing import Any

from glrt.core import files
from glrt.core.errors import UsageError

ENDING = ".html"


def check_page(path: str | Path, option: str) -> None:
    """Raise `UsageError` if a page cannot be written to `path`, the value of an option."""
    check_page_name(path, option)
    files.check_writable(Path(path))


def check_page_name(path: str | Path, option: str) -> None:
    """Raise `UsageError` if `path`, the value of an option, does not end in .html."""
    if Path(path).suffix.lower() != ENDING:
        raise UsageError(f"Cannot write {path}: the file of {option} must end in {ENDING}.")


def save_web_page(path: str | Path, title: str, data: Any, body: tuple[str, str]) -> None:
    """Write a page whole, or not at all; RenderError if it cannot be written.

    `data` are values of JSON; scripts find them as `data`. `body` is the package and the name of
    a file with style, markup and script, which are placed below the common ones.
    """
    package, name = body
    text = json.dumps(data, allow_nan=False).replace("<", "\\u003c")  # no tag may end the script
    parts = {"TITLE": escape(title), "BODY": _text(package, name), "DATA": text}
    page = _text("glrt.core", "web_page.html")
    for mark, part in parts.items():  # the data last: nothing in it is replaced
        page = page.replace(f"__{mark}__", part, 1)
    files.write_text(Path(path), page)


def _text(package: str, name: str) -> str:
    return (resources(package) / name).read_text("utf-8")
