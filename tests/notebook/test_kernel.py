"""The notebook of the guide in a real kernel, and its pictures, asked as a page asks them."""

import json
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from glrt.notebook.messages import Reply
from glrt.view.state.preview_size import STILL
from tests.notebook.answers import codes, samples
from tests.support.jupyter_server import own_folders
from tests.support.system_packages import needs_jupyter

NOTEBOOK = Path(__file__).parents[2] / "docs" / "notebooks" / "first.ipynb"
MOST_BYTES = 300_000
PATIENCE = 120.0  # seconds for a reply, which may wait for a compilation

pytestmark = pytest.mark.slow


class Page:
    """The messages of a page, in place of a browser."""

    def __init__(self, client: Any, model: str) -> None:
        self._client, self._model = client, model

    def send(self, **content: Any) -> None:
        data = {"comm_id": self._model, "data": {"method": "custom", "content": content}}
        self._client.shell_channel.send(self._client.session.msg("comm_msg", data))

    def ask(self, **given: Any) -> Reply:
        self.send(kind="ask", page="p", asked=given)
        while True:
            message = self._client.get_iopub_msg(timeout=PATIENCE)
            content = message["content"]
            if message["msg_type"] == "comm_msg" and content["comm_id"] == self._model:
                picture = bytes(message["buffers"][0]) if message["buffers"] else None
                return Reply(content["data"]["content"], picture)


@pytest.fixture(scope="module")
def client(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Any]:
    needs_jupyter()
    from jupyter_client.manager import KernelManager

    folder = tmp_path_factory.mktemp("kernel")
    manager = KernelManager(kernel_name="python3")
    manager.start_kernel(env=own_folders(folder), cwd=str(folder))
    client = manager.client()
    client.start_channels()
    client.wait_for_ready(timeout=PATIENCE)
    yield client
    client.stop_channels()
    manager.shutdown_kernel(now=True)


def run(client: Any, code: str) -> list[dict[str, Any]]:
    """Run a cell; the values and outputs that it shows."""
    outputs: list[dict[str, Any]] = []

    def keep(message: dict[str, Any]) -> None:
        assert message["msg_type"] != "error", message["content"]["traceback"]
        if message["msg_type"] in ("execute_result", "display_data", "stream"):
            outputs.append(message["content"])

    client.execute_interactive(code, timeout=PATIENCE, output_hook=keep)
    return outputs


def shown(client: Any, code: str) -> Page:
    """The page of the live picture that a cell shows."""
    (output,) = run(client, code)
    return Page(client, output["data"]["application/vnd.jupyter.widget-view+json"]["model_id"])


def begun(page: Page) -> Reply:
    """The first reply with a picture."""
    for _ in range(20):
        if (reply := page.ask()).picture:
            return reply
    raise AssertionError(reply)


def test_every_cell_of_the_notebook_runs(tmp_path: Path) -> None:
    needs_jupyter()
    made = tmp_path / "made.ipynb"
    command = [sys.executable, "-m", "nbconvert", "--to", "notebook", "--execute"]
    done = subprocess.run(
        [*command, str(NOTEBOOK), "--output", str(made)],
        capture_output=True,
        text=True,
        cwd=tmp_path,
        env=own_folders(tmp_path),
    )
    assert done.returncode == 0, done.stderr
    cells = json.loads(made.read_text())["cells"]
    types = {
        name for cell in cells for it in cell.get("outputs", []) for name in it.get("data", {})
    }
    assert "application/vnd.jupyter.widget-view+json" in types
    assert "image/png" in types
    assert "image/jpeg" in types, "a live picture leaves a still one in the notebook"


def test_the_notebook_is_small_and_names_no_machine() -> None:
    text = NOTEBOOK.read_text()
    assert len(text.encode()) < MOST_BYTES
    places = Path.home(), Path(tempfile.gettempdir()), NOTEBOOK.parents[2]
    assert not any(str(place) in text for place in places)


def test_a_picture_refines_turns_and_is_closed(client: Any) -> None:
    run(client, "import glrt")
    page = shown(
        client, "picture = glrt.show('cornell', width=48, height=48, samples=100_000); picture"
    )
    first = begun(page)
    assert codes(first).shape == (48, 48, 3)
    for _ in range(5):
        later = page.ask()
    assert samples(later) > samples(first)
    page.ask(turn=[0.2, 0.0])
    time.sleep(STILL)
    turned = [page.ask() for _ in range(8)][-1]
    assert codes(turned).shape == (48, 48, 3)
    assert abs(codes(turned) - codes(later)).mean() > 8
    (place,) = run(client, "picture.scene.camera.position")
    (start,) = run(client, "glrt.load('cornell').camera.position")
    assert place["data"]["text/plain"] != start["data"]["text/plain"]
    run(client, "image = picture.image(); assert image.samples > 0")
    page.send(kind="close", page="p")
    (session,) = run(client, "picture._live._session is None")
    assert session["data"]["text/plain"] == "True"
    assert samples(page.ask()) == 0


def test_pictures_share_a_context_with_each_other_and_with_renders(client: Any) -> None:
    run(client, "import glrt, glrt.notebook.shared_context as shared")
    pages = [shown(client, f"glrt.show('cornell', width=32, height=32, seed={n})") for n in (1, 2)]
    before = [samples(begun(page)) for page in pages]
    (told,) = run(client, "glrt.render(glrt.load('cornell'), 2, width=16, height=16).samples")
    assert told["data"]["text/plain"] == "2"
    assert all(samples(page.ask()) >= had for page, had in zip(pages, before, strict=True))
