"""Renderers, each in a process that renders on request, so that its start is not timed.

Requests and answers are lines of JSON on stdin and stdout; pictures are passed as files. The
process of the benchmark imports none of the others, and a crash of one does not affect it.
"""

import ctypes
import hashlib
import json
import os
import shutil
import signal
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from bench.processes import Process
from glrt.core.errors import GlrtError, RenderError
from glrt.image.image import Image
from glrt.scene.files.assets import AssetFolder
from glrt.scene.loading.file_copies import copy_files
from glrt.scene.loading.scene_files import files_of, hashes_of, with_files
from glrt.scene.scene import Scene
from glrt.scene.scenefile.toml import parse_scene, scene_to_dict

PREFIX = "glrt-peer-"  # of the temporary folders in which pictures are passed
_FILES = tempfile.TemporaryDirectory(prefix=PREFIX)
FORGOTTEN = 24 * 3600.0  # seconds since the last picture after which a folder is removed


@dataclass(frozen=True)
class Request:
    """A picture to render; a renderer ignores the fields that it does not support."""

    scene: str  # as JSON
    width: int
    height: int
    bounces: int
    samples: int
    seed: int
    method: str = "mis"
    sampler: str = ""  # by the renderer's own name; default: its usual one
    chooses: bool = False  # particles may be added, as the renderer finds best for a long render
    roulette: bool = True
    one_sided: bool = False  # quads emit light only on the side of their normal
    finite: bool = False  # planes may be replaced by large polygons
    native: bool = False  # materials may be replaced by similar ones of the renderer's own
    folder: str = ""  # of the files that the scene names
    batches: int = 1  # parts from which standard errors are estimated; with 1 there are none

    @classmethod
    def of(cls, scene: Scene, **settings: Any) -> "Request":
        """A request for `scene` with the fields `settings`."""
        files = {"folder": str(_folder_of(scene))} if files_of(scene) else {}
        return cls(scene=json.dumps(scene_to_dict(scene)), **{**files, **settings})

    def parsed(self) -> Scene:
        """The scene of the request."""
        scene = parse_scene(json.loads(self.scene), "request")
        return with_files(scene, AssetFolder(Path(self.folder)), "request")


def _folder_of(scene: Scene) -> Path:
    """A folder with the files of a scene, until this process ends."""
    folder = Path(_FILES.name, hashlib.sha256(json.dumps(hashes_of(scene)).encode()).hexdigest())
    folder.mkdir(exist_ok=True)
    copy_files(scene, folder)
    return folder


class Peer:
    """The running process of a renderer."""

    def __init__(self, command: Sequence[str], is_paused_at_rest: bool = False) -> None:
        """Start it; raises RenderError with its last message if it does not get ready.

        With `is_paused_at_rest` it is stopped whenever it does not render.
        """
        self._is_paused_at_rest = is_paused_at_rest
        _remove_forgotten_folders()
        self._folder = tempfile.TemporaryDirectory(prefix=PREFIX)
        self._process = Process(command, Path(self._folder.name, "log"))
        try:
            self.name = str(self._process.answer()["name"])  # with its version
        except RenderError:
            self.close()
            raise
        if is_paused_at_rest:
            self._process.pause()

    def render(self, request: Request) -> tuple[Image, float]:
        """Return a picture and the seconds that it took; raises RenderError on failure."""
        output = Path(self._folder.name, "picture.exr")
        with self._awake():
            answer = self._process.ask({**asdict(request), "output": str(output)})
        return Image.load(output), answer["seconds"]

    @contextmanager
    def _awake(self) -> Iterator[None]:
        if not self._is_paused_at_rest:
            yield
            return
        self._process.resume()
        try:
            yield
        finally:
            self._process.pause()

    def close(self) -> None:
        """End the program."""
        self._process.close()
        self._folder.cleanup()


def _remove_forgotten_folders() -> None:
    """Remove folders left behind by processes that were killed."""
    for folder in Path(tempfile.gettempdir()).glob(f"{PREFIX}*"):
        with suppress(OSError):
            if time.time() - folder.stat().st_mtime > FORGOTTEN:
                shutil.rmtree(folder, ignore_errors=True)


def serve(name: str, render: Callable[[Request], tuple[Image, float]]) -> None:
    """Answer requests until stdin ends; called in the process of the renderer `name`."""
    _end_with_parent()
    answers = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)  # output of libraries must not mix with the answers

    def answer(**words: Any) -> None:
        print(json.dumps(words), file=answers, flush=True)

    answer(name=name)
    for line in sys.stdin:
        words = json.loads(line)
        output = words.pop("output")
        try:
            image, seconds = render(Request(**words))
            image.save(output)
        except GlrtError as error:
            answer(error=str(error))
        else:
            answer(seconds=seconds)


def _end_with_parent() -> None:
    """On Linux, let this process end with its parent; a paused one does not see stdin end."""
    if sys.platform == "linux":
        set_signal_of_parents_end = 1  # PR_SET_PDEATHSIG
        ctypes.CDLL(None).prctl(set_signal_of_parents_end, signal.SIGKILL)
