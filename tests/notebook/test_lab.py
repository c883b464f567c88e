"""A live picture in JupyterLab, driven by the mouse in a headless Chromium."""

import base64
import io
import json
import math
import time
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image

from tests.support.driven_browser import PATIENCE, Driven, driven
from tests.support.jupyter_server import lab

pytestmark = pytest.mark.slow

CELLS = [
    "import glrt\nroom = glrt.show('cornell', width=320, height=240)\nroom",
    "lamps = glrt.show('lamps', width=160, height=120)\nlamps",
]
PICTURES = "[...document.querySelectorAll('.glrt-show')].map(it => Number(it.dataset.pictures))"
SECONDS = 3.0  # of a drag
REACH = 50  # pixels, to the right and then to the left
ROOM = "document.querySelectorAll('.glrt-show')[0]"


@pytest.fixture(scope="module")
def page(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Driven]:
    """A notebook with two live pictures, drawn at least once each."""
    folder = tmp_path_factory.mktemp("lab")
    root = folder / "notebooks"
    root.mkdir()
    cells: list[dict[str, Any]] = [
        {"cell_type": "code", "execution_count": None, "metadata": {}, "outputs": [], "source": it}
        for it in CELLS
    ]
    spec = {"kernelspec": {"name": "python3", "display_name": "Python 3", "language": "python"}}
    notebook = {"cells": cells, "metadata": spec, "nbformat": 4, "nbformat_minor": 4}
    (root / "live.ipynb").write_text(json.dumps(notebook))
    with lab(root, folder) as address, driven(folder / "profile") as browser:
        browser.open(f"{address}/doc/tree/live.ipynb", 1000, 1500)
        browser.until("window.jupyterapp?.shell.currentWidget?.context?.isReady")
        browser.until("jupyterapp.shell.currentWidget.sessionContext.session?.kernel?.id")
        browser.value("jupyterapp.commands.execute('notebook:run-all-cells')")
        browser.until(f"{PICTURES}.filter(it => it > 0).length === 2")
        yield browser


def codes(page: Driven, number: int = 0) -> NDArray[np.int64]:
    """Pixels of a picture as the page shows them, (H, W, 3)."""
    canvas = f"document.querySelectorAll('.glrt-show canvas')[{number}]"
    address = page.value(f"{canvas}.toDataURL('image/png')")
    file = io.BytesIO(base64.b64decode(address.partition(",")[2]))
    with Image.open(file) as shown:
        return np.asarray(shown.convert("RGB")).astype(np.int64)


def samples(page: Driven) -> int:
    return int(page.value(f"parseInt({ROOM}.querySelector('.figures').innerText)"))


def box(page: Driven, selector: str) -> dict[str, float]:
    """The place of a part of the first picture in the window, which it is brought into."""
    found: dict[str, float] = page.value(
        f"(() => {{ const part = {ROOM}.querySelector({json.dumps(selector)});"
        "part.scrollIntoView({ block: 'nearest' });"
        "const { x, y, width, height } = part.getBoundingClientRect();"
        "return { x, y, width, height }; })()"
    )
    return found


def until(is_so: Callable[[], Any]) -> None:
    """Wait until something is so, however busy the machine is."""
    end = time.monotonic() + PATIENCE
    while not is_so():
        assert time.monotonic() < end, "it is not so"
        time.sleep(0.2)


def refined(page: Driven) -> None:
    """Wait until a picture of full size has some samples."""
    figures = f"{ROOM}.querySelector('.figures').innerText"
    page.until(f"!{figures}.includes('coarse') && parseInt({figures}) >= 4")


def test_two_pictures_refine_and_show_their_costs_errors_and_forecasts(page: Driven) -> None:
    refined(page)
    before = samples(page)
    page.until(f"parseInt({ROOM}.querySelector('.figures').innerText) > {before}")
    page.until(f"/error [0-9.]+ %/.test({ROOM}.querySelector('.figures').innerText)")
    figures = page.value(f"{ROOM}.querySelector('.figures').innerText").splitlines()
    assert "2 %" in figures[-1]
    labels = page.value(f"[...{ROOM}.querySelectorAll('label')].map(it => it.textContent)")
    assert labels[:2] == ["bounces", "samples"]
    assert len(labels) >= 3
    assert len(page.value(f"[...{ROOM}.querySelectorAll('.cost')].map(it => it.title)")) >= 3
    assert codes(page, 0).std() > 20
    assert codes(page, 1).std() > 20


def test_a_drag_turns_the_picture_and_a_double_click_leads_back(page: Driven) -> None:
    refined(page)
    before, place = codes(page), box(page, "canvas")
    x, y = place["x"] + place["width"] / 2, place["y"] + place["height"] / 2
    held: dict[str, Any] = {"button": "left", "buttons": 1, "clickCount": 1}
    page.mouse("mousePressed", x, y, **held)
    start, drawn = time.monotonic(), page.value(PICTURES)[0]
    while (passed := time.monotonic() - start) < SECONDS:
        page.mouse("mouseMoved", x + REACH * math.sin(passed * 1.5 * math.pi / SECONDS), y, **held)
    rate = (page.value(PICTURES)[0] - drawn) / (time.monotonic() - start)
    page.mouse("mouseReleased", x - REACH, y, button="left", clickCount=1)
    print(f"{rate:.1f} pictures a second while orbiting at 320 x 240")
    until(lambda: abs(codes(page) - before).mean() > 10)
    refined(page)
    turned = codes(page)
    for count in (1, 2):
        for kind in ("mousePressed", "mouseReleased"):
            page.mouse(kind, x, y, button="left", clickCount=count)
    until(lambda: abs(codes(page) - before).mean() < abs(turned - before).mean() / 2)


def test_a_slider_changes_the_picture(page: Driven) -> None:
    refined(page)
    before, place = codes(page), box(page, "input[data-key^='light ']")
    y = place["y"] + place["height"] / 2
    for kind in ("mousePressed", "mouseReleased"):
        page.mouse(kind, place["x"] + place["width"] - 3, y, button="left", clickCount=1)
    page.until(f"Number({ROOM}.querySelectorAll('output')[2].textContent) > 8")
    until(lambda: codes(page).mean() > 1.3 * before.mean())


def test_closed_pictures_and_cells_get_no_more_pictures(page: Driven) -> None:
    refined(page)
    assert told(page, "lamps.close()") == ""
    page.until("document.querySelectorAll('.glrt-show').length === 1")
    page.value("jupyterapp.commands.execute('editmenu:clear-all')")
    page.until("document.querySelectorAll('.glrt-show').length === 0")
    code = "print(room._live._session, lamps._live._session)"
    until(lambda: told(page, code) == "None None")


def told(page: Driven, code: str) -> str:
    """The text that code prints in the kernel of the notebook."""
    text: str = page.value(f"""(async () => {{
        const {{ kernel }} = jupyterapp.shell.currentWidget.sessionContext.session;
        const run = kernel.requestExecute({{ code: {json.dumps(code)} }});
        let text = "";
        run.onIOPub = it => {{ if (it.header.msg_type === "stream") text += it.content.text; }};
        await run.done;
        return text;
    }})()""")
    return text.strip()
