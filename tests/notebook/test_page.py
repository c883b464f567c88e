"""The program of the page, in a headless Chromium, with a kernel that is played."""

import base64
import io
import json
from importlib.resources import files
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from tests.support.browser import found_in

ROWS = [
    {
        "key": key,
        "label": key.removeprefix("light "),
        "value": value,
        "low": low,
        "high": high,
        "whole": whole,
        "logarithmic": low == 1,
        "help": "help",
        "costs": [{"cost": "restart", "where": "", "meaning": "restarts the picture"}],
    }
    for key, value, low, high, whole in (
        ("bounces", 8, 0, 32, True),
        ("samples", 256, 1, 65536, True),
        ("light lamp", 1.0, 0, 10, False),
    )
]
# Under virtual time, the browser has no frames of its own while nothing is drawn.
FRAMES = """
globalThis.requestAnimationFrame = draw => setTimeout(draw, 16);
globalThis.cancelAnimationFrame = clearTimeout;
"""
PLAYED = """
const sent = [], size = [64, 48];
const model = {
  get: name => ({ _title: "a room", _size: size })[name],
  on(name, hear) { this.hear = hear; },
  off() { this.hear = () => {}; },
  send: message => sent.push(structuredClone(message)),
};
const frames = count => new Promise(done => setTimeout(done, 20 * count));
const reply = (more, buffers = []) =>
  model.hear({ page: sent.at(-1).page, wait: 0, rows, figures: [], notice: "", ...more }, buffers);
const mouse = (kind, x, y, buttons = 1) => {
  const { left, top } = canvas.getBoundingClientRect();
  const place = { clientX: left + x, clientY: top + y };
  canvas.dispatchEvent(new PointerEvent(kind, { pointerId: 1, buttons, ...place }));
};
const slide = (key, share) => {
  const input = document.querySelector(`[data-key="${key}"]`);
  input.value = 1000 * share;
  input.dispatchEvent(new Event("input"));
};
"""


@pytest.fixture(scope="module")
def page(tmp_path_factory: pytest.TempPathFactory) -> Path:
    parts = files("glrt.notebook")
    program = parts.joinpath("widget.js").read_text("utf-8")
    assert program.count("export default { render };") == 1
    program = program.replace("export default { render };", "")
    file = tmp_path_factory.mktemp("page") / "page.html"
    style = parts.joinpath("widget.css").read_text("utf-8")
    file.write_text(
        f"<!doctype html><html><meta charset=utf-8><style>{style}</style>"
        f"<div id=cell></div><script>{FRAMES}{program}{PLAYED}const rows = {json.dumps(ROWS)};"
        'const end = render({ model, el: document.getElementById("cell") });'
        'const canvas = document.querySelector("canvas"); canvas.setPointerCapture = () => {};'
        "const ready = frames(2);</script></html>",
        "utf-8",
    )
    return file


def test_it_asks_draws_and_asks_again(page: Path) -> None:
    file = io.BytesIO()
    Image.fromarray(np.full((24, 32, 3), (10, 200, 30), np.uint8)).save(file, "PNG")
    coded = base64.b64encode(file.getvalue()).decode()
    script = f"""
    found = {{ first: sent.map(it => [it.kind, it.asked.wheel]) }};
    const bytes = Uint8Array.from(atob("{coded}"), it => it.charCodeAt(0));
    reply({{ type: "image/png", figures: ["4 of 9 samples", "error 3 %"], notice: "No room" ,
      is_problem: true }}, [new DataView(bytes.buffer)]);
    while (!document.querySelector(".glrt-show").dataset.pictures) await frames(1);
    found.code = [...canvas.getContext("2d").getImageData(50, 40, 1, 1).data].slice(0, 3);
    found.asked = sent.length;
    found.figures = document.querySelector(".figures").innerText;
    found.notice = document.querySelector(".notice.problem").textContent;
    found.rows = [...document.querySelectorAll(".rows label")].map(it => it.textContent);
    found.costs = [...document.querySelectorAll(".cost")].map(it => [it.textContent, it.title]);
    found.values = [...document.querySelectorAll("output")].map(it => it.textContent);
    """
    found = found_in(page, script)
    assert found["first"] == [["ask", 0]]
    assert found["code"] == [10, 200, 30]
    assert found["asked"] == 2
    assert found["figures"].splitlines() == ["4 of 9 samples", "error 3 %"]
    assert found["notice"] == "No room"
    assert found["rows"] == ["bounces", "samples", "lamp"]
    assert found["costs"] == [["restart", "restarts the picture"]] * 3
    assert found["values"] == ["8", "256", "1"]


def test_input_goes_along_with_the_next_question(page: Path) -> None:
    script = """
    canvas.focus();
    mouse("pointerdown", 10, 10);
    mouse("pointermove", 26, 10);
    mouse("pointermove", 42, 22);
    mouse("pointermove", 60, 40, 0);
    canvas.dispatchEvent(new WheelEvent("wheel", { deltaY: -200, cancelable: true }));
    await frames(3);
    found = { before: sent.length };
    reply({});
    await frames(3);
    found.turn = sent.at(-1).asked;
    reply({ wait: null });
    await frames(3);
    found.idle = sent.length;
    slide("samples", 0.5);
    slide("light lamp", 0.25);
    await frames(3);
    found.slid = sent.at(-1).asked;
    reply({ wait: null });
    canvas.dispatchEvent(new KeyboardEvent("keydown", { key: "ArrowLeft" }));
    await frames(3);
    found.turned = sent.at(-1).asked.turn;
    reply({ wait: null });
    canvas.dispatchEvent(new MouseEvent("dblclick"));
    await frames(3);
    found.home = sent.at(-1).asked.home;
    """
    found: Any = found_in(page, script)
    assert found["before"] == 1, "one question at a time"
    assert found["turn"]["turn"] == pytest.approx([32 / 64, 12 / 48])
    assert found["turn"]["wheel"] == 2
    assert found["idle"] == 2, "a picture that is done asks for nothing"
    assert found["slid"]["settings"] == {"samples": 256}
    assert found["slid"]["lights"] == {"lamp": 2.5}
    assert found["turned"][0] < 0
    assert found["home"]


def test_the_wheel_scrolls_the_page_until_the_picture_has_the_focus(page: Path) -> None:
    script = """
    const scroll = new WheelEvent("wheel", { deltaY: 100, cancelable: true });
    canvas.dispatchEvent(scroll);
    reply({});
    await frames(3);
    found = [scroll.defaultPrevented, sent.at(-1).asked.wheel];
    """
    assert found_in(page, script) == [False, 0]


def test_a_closed_cell_asks_for_no_more(page: Path) -> None:
    script = """
    const page = sent[0].page, hear = model.hear;
    end();
    end();
    hear({ page, wait: 0, rows, figures: [] }, []);
    mouse("pointermove", 20, 20);
    await frames(3);
    found = sent.map(it => it.kind);
    """
    assert found_in(page, script) == ["ask", "close"]


def test_the_reply_to_another_page_is_shown_and_not_answered(page: Path) -> None:
    script = """
    model.hear({ page: "other", wait: 0, rows, figures: ["9 samples"] }, []);
    await frames(3);
    found = [sent.length, document.querySelector(".figures").innerText];
    """
    assert found_in(page, script) == [1, "9 samples"]
