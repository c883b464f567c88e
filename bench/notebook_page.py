"""A live picture in JupyterLab, as the page on notebooks shows it."""

import io
import json
import tempfile
from pathlib import Path
from typing import Any

import pytest

from bench.contact_sheet import write_bytes
from glrt.core.errors import RenderError
from tests.support.driven_browser import driven
from tests.support.jupyter_server import lab

CELL = 'import glrt\n\npicture = glrt.show("lamps", width=360, height=240)\npicture'
WINDOW = (1000, 900)  # pixels
SAMPLES = 48  # of the picture that is shown
SHOWN = "parseInt(document.querySelector('.glrt-show .figures')?.innerText)"
ENOUGH = f"{SHOWN} >= {SAMPLES}"
MARGIN = 8  # pixels around the cell


def notebook(file: Path) -> None:
    """A cell with a live picture, in JupyterLab; needs Chromium."""
    try:
        with tempfile.TemporaryDirectory() as folder:
            write_bytes(file, _taken(Path(folder)))
    except (pytest.skip.Exception, pytest.fail.Exception, AssertionError) as error:
        raise RenderError(f"no picture of JupyterLab: {error}.") from None


def _taken(folder: Path) -> bytes:
    root = folder / "notebooks"
    root.mkdir()
    (root / "live.ipynb").write_text(json.dumps(_document()), "utf-8")
    with lab(root, folder) as address, driven(folder / "profile") as page:
        page.open(f"{address}/doc/tree/live.ipynb", *WINDOW)
        page.until("window.jupyterapp?.shell.currentWidget?.context?.isReady")
        page.until("jupyterapp.shell.currentWidget.sessionContext.session?.kernel?.id")
        page.value("jupyterapp.commands.execute('notebook:run-all-cells')")
        page.until(ENOUGH)
        box = page.value(
            "(() => { const { x, y, width, height } = "
            "document.querySelector('.jp-Cell').getBoundingClientRect();"
            "return [x, y, width, height]; })()"
        )
        page.screenshot(folder / "page.png")
    return _cut(folder / "page.png", box)


def _document() -> dict[str, Any]:
    cell: dict[str, Any] = {"cell_type": "code", "execution_count": None}
    cell |= {"metadata": {}, "outputs": [], "source": CELL}
    spec = {"name": "python3", "display_name": "Python 3", "language": "python"}
    return {
        "cells": [cell],
        "metadata": {"kernelspec": spec},
        "nbformat": 4,
        "nbformat_minor": 4,
    }


def _cut(file: Path, box: list[float]) -> bytes:
    """The part of a screenshot that shows a cell, encoded."""
    from PIL import Image

    left, top, width, height = map(round, box)
    ends = left + width + MARGIN, top + height + MARGIN
    encoded = io.BytesIO()
    with Image.open(file) as page:
        cut = page.convert("RGB").crop((max(left - MARGIN, 0), max(top - MARGIN, 0), *ends))
        cut.save(encoded, "WEBP", quality=80, method=6)
    return encoded.getvalue()
