"""Save the files of a render, at intervals and at the end."""

import secrets
import shlex
import tempfile
import time
from collections.abc import Callable, Sequence
from pathlib import Path

from glrt.core.errors import RenderError
from glrt.core.files import reason
from glrt.image.image import Image
from glrt.process.command import report
from glrt.rendering.renderer import Renderer

INTERVAL = 60.0  # seconds between two saves: what a power cut may cost
SHARE = 0.05  # largest share of the time that saving takes


class Autosave:
    """Saves a picture under all its names, each file whole or not at all."""

    def __init__(self, outputs: Sequence[str], clock: Callable[[], float] = time.monotonic) -> None:
        """Start the clock; the first save comes after one interval."""
        self._outputs = outputs
        self._clock = clock
        self._due = clock() + INTERVAL
        self.kept = 0  # samples of the picture that was saved last; 0: none

    def after(self, renderer: Renderer) -> None:
        """Save if due. A failure is reported and the render continues: space may become free."""
        start = self._clock()
        if start < self._due or renderer.samples <= self.kept:
            return
        try:
            failures = self._save(renderer.image())
        except MemoryError as error:
            failures = [f"No memory to save the picture: {reason(error)}."]
        if failures:
            report(f"glrt: {failures[0]} The render continues; it will be saved again at the end.")
        else:
            self.kept = renderer.samples
        now = self._clock()
        self._due = now + max(INTERVAL, (now - start) / SHARE)

    def keep(self, image: Image) -> None:
        """Save at the end. RenderError names a file that failed, and where the picture is."""
        if failures := self._save(image):
            raise RenderError(f"{failures[0]} {self._elsewhere(image)}".strip())

    @property
    def advice(self) -> str:
        """How to continue from the last save when the driver fails; empty if there was none."""
        if not self.kept:
            return ""
        state = next((name for name in self._outputs if _is_state(name)), None)
        if state is None:
            return f"{self._outputs[0]} shows the first {self.kept} samples."
        name = shlex.quote(state)
        return (
            f"The first {self.kept} samples are saved: `glrt render --resume {name} -o {name}` "
            "continues from them."
        )

    def _save(self, image: Image) -> list[str]:
        """Save all outputs; returns the messages of the failures."""
        failures = {}
        for output in self._outputs:
            try:
                image.save(output)
            except RenderError as error:
                failures[output] = str(error)
        self._is_safe = any(_is_state(name) and name not in failures for name in self._outputs)
        return list(failures.values())

    def _elsewhere(self, image: Image) -> str:
        """Save to the temporary folder unless an .exr output was written; returns a message."""
        if self._is_safe:
            return "The .exr file is saved, and `glrt render` makes the others from it."
        place = Path(tempfile.gettempdir()) / f"glrt-{secrets.token_hex(4)}.exr"
        try:
            image.save(place)
        except RenderError:
            return ""
        return f"The picture is in {place}."


def _is_state(name: str) -> bool:
    """Whether a render can continue from a file of this name."""
    return name.lower().endswith(".exr")
