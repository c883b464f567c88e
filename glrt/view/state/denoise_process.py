"""Denoiser in a process of its own: it takes no time from frames, and ends with the window.

`python -m glrt.view.state.denoise_process` reads two halves of the samples and the name of a
filter from its input, and writes the denoised picture. Both are pickled.
"""

import pickle
import subprocess
import sys
from tempfile import TemporaryFile
from threading import Lock

from glrt.denoise.denoising import Denoised, denoise
from glrt.denoise.half import Half

COMMAND = [sys.executable, "-m", "glrt.view.state.denoise_process"]


class DenoiseProcess:
    """The denoising process: one thread waits for it, another may end it."""

    def __init__(self) -> None:
        """Start nothing yet."""
        self._process: subprocess.Popen[bytes] | None = None
        self._is_ended, self._lock = False, Lock()

    def run(self, halves: tuple[Half, Half], name: str) -> Denoised | None:
        """Denoise two halves by the filter of this name; None if that was ended, or failed."""
        with TemporaryFile() as given, TemporaryFile() as made:
            pickle.dump((halves, name), given)
            given.seek(0)
            with self._lock:
                if self._is_ended:
                    return None
                self._process = subprocess.Popen(
                    COMMAND, stdin=given, stdout=made, stderr=subprocess.DEVNULL
                )
            if self._process.wait():
                return None
            made.seek(0)
            found: Denoised = pickle.load(made)
            return found

    def end(self) -> None:
        """Stop the process: its result is no longer needed."""
        with self._lock:
            self._is_ended = True
            if self._process:
                self._process.kill()


if __name__ == "__main__":
    pickle.dump(denoise(*pickle.load(sys.stdin.buffer)), sys.stdout.buffer)
