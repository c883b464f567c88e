"""Pages in a headless Chromium: pictures of them, and what a script of a test finds there."""

import base64
import json
import shutil
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from tests.support.system_packages import needs_package

NAMES = ("chromium-headless-shell", "chromium", "google-chrome")
DARK = 64  # code of a pixel: the ground of the dark style is below it
OPTIONS = ("--no-sandbox", "--disable-gpu", "--hide-scrollbars", "--virtual-time-budget=20000")


def browser() -> str:
    """The program, or a skipped test."""
    found = next((path for name in NAMES if (path := shutil.which(name))), None)
    needs_package(found is not None, NAMES[0])
    assert found
    return found


def found_in(page: Path, script: str, width: int = 1000) -> Any:
    """Run statements in a page that is ready, and return the value of `found`, as JSON.

    They stand in an async function. An error in the page or in the script fails the test.
    """
    text = page.read_text("utf-8")
    probe = f"""<script>
    addEventListener("error", event => {{ document.title = "error: " + event.message; }});
    (async () => {{
        await ready;
        let found;
        {script}
        document.body.innerHTML = "<pre id=found></pre>";
        document.getElementById("found").textContent = btoa(JSON.stringify(found));
    }})().catch(error => {{ document.title = "error: " + error.stack; }});
    </script>"""
    tried = page.with_name(f"tried-{page.name}")
    tried.write_text(text.replace("</html>", f"{probe}</html>"), "utf-8")
    done = _run(f"--window-size={width},900", "--dump-dom", tried.as_uri())
    start = done.find('<pre id="found">')
    assert start >= 0, done[:3000]
    coded = done[start:].partition(">")[2].partition("<")[0]
    return json.loads(base64.b64decode(coded))


def screenshot(
    page: Path, file: Path, width: int = 1000, height: int = 1200, dark: bool = False
) -> None:
    """Write a picture of a page, as PNG, in the dark style or in the light one."""
    scheme = f"--blink-settings=preferredColorScheme={0 if dark else 1}"
    _run(scheme, f"--window-size={width},{height}", f"--screenshot={file}", page.as_uri())


def codes_of(page: Path, folder: Path, width: int, dark: bool) -> NDArray[np.int64]:
    """Pixels of a page, (H, W, 3), which must fit its width and have the ground of its style."""
    script = "found = document.documentElement.scrollWidth - innerWidth;"
    assert found_in(page, script, width) <= 0, "the page scrolls sideways"
    screenshot(page, folder / "page.png", width, 900, dark)
    with Image.open(folder / "page.png") as shown:
        codes = np.asarray(shown.convert("RGB")).astype(np.int64)
    assert (np.median(codes) < DARK) == dark, "the ground"
    return codes


def _run(*words: str) -> str:
    command = [browser(), *OPTIONS, *words]
    done = subprocess.run(command, capture_output=True, text=True, timeout=100)
    assert done.returncode == 0, done.stderr
    return done.stdout
