"""Other renderers, each a program that stays and renders on request: its start is not timed.

It gets one request a line on stdin and answers each with a line on stdout, both JSON; pictures go
through files. So glrt never imports them, and a crash of theirs ends them alone.
"""

import json
import os
import shutil
import sys
import tempfile
import time
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from bench.processes import Process
from glrt.errors import GlrtError, RenderError
from glrt.image.image import Image
from glrt.scene.scene import Scene
from glrt.scene.toml import parse_scene, scene_to_dict

PREFIX = "glrt-peer-"  # of folders for pictures on their way, among the temporary files
FORGOTTEN = 24 * 3600.0  # seconds without a new picture


@dataclass(frozen=True)
class Request:
    """What to render; a peer ignores what it does not know."""

    scene: str  # as JSON
    width: int
    height: int
    bounces: int
    samples: int
    seed: int
    roulette: bool = True
    one_sided: bool = False  # quads that emit light do so along their normal alone
    finite: bool = False  # planes may end far away
    batches: int = 1  # the picture knows its errors from so many parts: of 1, it does not

    @classmethod
    def of(cls, scene: Scene, **settings: Any) -> "Request":
        """A request whose other fields are `settings`."""
        return cls(scene=json.dumps(scene_to_dict(scene)), **settings)

    def parsed(self) -> Scene:
        """The scene."""
        return parse_scene(json.loads(self.scene), "request")


class Peer:
    """The program of another renderer, started and ready."""

    def __init__(self, command: Sequence[str]) -> None:
        """Start it; RenderError, with the reason that it gave, if it does not get ready."""
        _remove_forgotten_folders()
        self._folder = tempfile.TemporaryDirectory(prefix=PREFIX)
        self._process = Process(command, Path(self._folder.name, "log"))
        try:
            self.name = str(self._process.answer()["name"])  # with its version
        except RenderError:
            self.close()
            raise

    def render(self, request: Request) -> tuple[Image, float]:
        """The picture, and the seconds that it took; RenderError if there is none."""
        output = Path(self._folder.name, "picture.exr")
        answer = self._process.ask({**asdict(request), "output": str(output)})
        return Image.load(output), answer["seconds"]

    def close(self) -> None:
        """End the program."""
        self._process.close()
        self._folder.cleanup()


def _remove_forgotten_folders() -> None:
    """Those of processes that were killed: nobody else is left to do it."""
    for folder in Path(tempfile.gettempdir()).glob(f"{PREFIX}*"):
        with suppress(OSError):
            if time.time() - folder.stat().st_mtime > FORGOTTEN:
                shutil.rmtree(folder, ignore_errors=True)


def serve(name: str, render: Callable[[Request], tuple[Image, float]]) -> None:
    """The other end, in the peer's program: answer requests until stdin ends."""
    answers = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)  # whatever a library prints must not come between

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
            answer(error=" ".join(str(error).split()))
        else:
            answer(seconds=seconds)
