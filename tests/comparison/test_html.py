"""The page of compared pictures, driven in a headless Chromium."""

import json
import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from glrt.comparison.heatmap import colors, strongest
from glrt.comparison.html import Compared, entry_of, save_page
from glrt.comparison.verdict import compare
from glrt.gpu.context import Context
from glrt.image.image import Image
from glrt.image.sources import load
from tests.support.browser import codes_of, found_in
from tests.support.processes import glrt
from tests.support.renders import rendered

CODES = """
const shown = () => current.canvas.getContext("2d");
const code = (x, y) => [...shown().getImageData(x, y, 1, 1).data].slice(0, 3);
const press = key => dispatchEvent(new KeyboardEvent("keydown", { key }));
"""


@pytest.fixture(scope="module")
def pictures(context: Context) -> tuple[Image, Image]:
    """A room, and the same room under lamps that are 10 % brighter."""
    size: Any = {"width": 48, "height": 36, "samples": 64}
    one = rendered(load("cornell"), context, **size)
    other = replace(one, radiance=np.float32(1.1) * one.radiance)
    return other, one


@pytest.fixture(scope="module")
def page(pictures: tuple[Image, Image], tmp_path_factory: pytest.TempPathFactory) -> Path:
    image, reference = pictures
    entries = [
        Compared("same", reference, reference, compare(reference, reference)),
        Compared("</script><b>room", image, reference, compare(image, reference)),
    ]
    file = tmp_path_factory.mktemp("page") / "page.html"
    save_page([entry_of(entry) for entry in entries], file)
    return file


def encoded(radiance: Any, stops: float = 0.0) -> list[int]:
    """The codes of a pixel of half floats, through sRGB."""
    x = np.clip(np.float64(np.float16(radiance)) * 2**stops, 0, 1)
    codes = np.where(x <= 0.0031308, 12.92 * x, 1.055 * x ** (1 / 2.4) - 0.055)
    return [int(code) for code in np.rint(255 * codes)]


def test_the_page_needs_no_network_and_shows_what_differs_first(page: Path) -> None:
    text = page.read_text()
    assert not re.search(r"https?:|@import|src=|url\(", text)
    assert text.count("</script>") == 3, "a name does not end the data"
    entries = json.loads(re.search(r'application/json">(.*?)</script>', text, re.DOTALL)[1])  # type: ignore[index]
    assert [entry["title"] for entry in entries] == ["</script><b>room", "same"]
    assert entries[0]["verdict"] == "different"


def test_keys_show_each_picture_the_difference_and_the_wipe(
    page: Path, pictures: tuple[Image, Image]
) -> None:
    script = f"""{CODES}
    found = {{ titles: [...document.querySelectorAll("h2")].map(it => it.textContent) }};
    found.wipe = [code(5, 20), code(40, 20)];
    for (const key of "nrd") {{ press(key); found[key] = code(20, 20); }}
    press("w");
    current.wiping.value = 0.1;
    current.wiping.dispatchEvent(new Event("input"));
    found.wiped = [code(2, 20), code(8, 20)];
    press("b");
    const first = code(20, 20).join();
    await new Promise(done => setTimeout(done, 600));
    found.blinked = code(20, 20).join() !== first;
    """
    found = found_in(page, script)
    image, reference = (it.radiance for it in pictures)
    assert found["titles"][0].startswith("</script><b>room: different")
    assert found["wipe"] == [encoded(image[20, 5]), encoded(reference[20, 40])]
    assert found["n"] == encoded(image[20, 20])
    assert found["r"] == encoded(reference[20, 20])
    scores = compare(*pictures).pixel_scores
    assert found["d"] == colors(strongest(scores))[20, 20].tolist()
    assert found["wiped"] == [encoded(image[20, 2]), encoded(reference[20, 8])]
    assert found["blinked"]


def test_exposure_and_zoom_act_on_the_framed_picture(
    page: Path, pictures: tuple[Image, Image]
) -> None:
    script = f"""{CODES}
    press("r"); press("-"); press("-");
    found = {{ darker: code(20, 20), stops: current.stops.textContent }};
    current.exposing.value = 2;
    current.exposing.dispatchEvent(new Event("input"));
    found.brighter = code(20, 20);
    press("0"); press("z");
    found.exact = current.canvas.getBoundingClientRect().width;
    press("z");
    found.doubled = current.canvas.getBoundingClientRect().width;
    current.canvas.dispatchEvent(new PointerEvent("pointermove", {{
        clientX: current.canvas.getBoundingClientRect().left + 10.5 * 2,
        clientY: current.canvas.getBoundingClientRect().top + 7.5 * 2 }}));
    found.under = current.under.textContent;
    cards[1].node.dispatchEvent(new PointerEvent("pointerenter"));
    press("n");
    found.modes = cards.map(card => card.mode);
    """
    found = found_in(page, script)
    radiance = pictures[1].radiance
    assert found["darker"] == encoded(radiance[20, 20], -1)
    assert found["stops"] == "-1"
    assert found["brighter"] == encoded(radiance[20, 20], 2)
    assert (found["exact"], found["doubled"]) == (48, 96)
    assert found["under"].startswith("x 10, y 7: new ")
    told = [float(word) for word in found["under"].partition("reference ")[2].split()]
    assert told == pytest.approx(radiance[7, 10], rel=1e-3)
    assert found["modes"] == ["reference", "new"]


@pytest.mark.parametrize(("width", "dark"), [(390, False), (1000, True)])
def test_the_page_fits_and_shows_its_pictures(
    page: Path, width: int, dark: bool, tmp_path: Path
) -> None:
    codes = codes_of(page, tmp_path, width, dark)
    reddish = (codes[..., 0] > codes[..., 1] + 60).mean()
    assert reddish > 0.01, "the red wall of the room"


def test_the_command_writes_the_page(pictures: tuple[Image, Image], tmp_path: Path) -> None:
    for name, image in zip("ab", pictures, strict=True):
        image.save(tmp_path / f"{name}.exr")
    done = glrt("compare", "a.exr", "b.exr", "--html", "page.html", cwd=tmp_path)
    assert done.returncode == 1
    assert '"a.exr and b.exr"' in (tmp_path / "page.html").read_text()
    done = glrt("compare", "a.exr", "b.exr", "--html", "page.pdf", cwd=tmp_path)
    assert done.returncode == 2
    assert "the file of --html must end in .html" in done.stderr
