"""Processes that answer requests: each request and each answer is a line of JSON."""

import json
import os
import signal
import subprocess
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from glrt.core.errors import RenderError

ROOT = Path(__file__).resolve().parent.parent  # folder of this checkout


class Process:
    """A running program that reads requests from stdin and writes answers to stdout."""

    def __init__(
        self, command: Sequence[str], log: Path, environment: Mapping[str, str] | None = None
    ) -> None:
        """Start it; its stderr is written to `log`."""
        self._log = log
        with log.open("w") as errors:
            self._process = subprocess.Popen(
                command,
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=errors,
                text=True,
                env=environment,
            )

    def ask(self, words: Mapping[str, Any]) -> dict[str, Any]:
        """Return the answer to a request; RenderError if it is an error or the program ended."""
        assert self._process.stdin
        try:
            print(json.dumps(words), file=self._process.stdin, flush=True)
        except BrokenPipeError:
            raise self._ended() from None
        answer = self.answer()
        if "error" in answer:
            raise RenderError(answer["error"])
        return answer

    def answer(self) -> dict[str, Any]:
        """Return the next answer; raises RenderError if the program has ended."""
        assert self._process.stdout
        line = self._process.stdout.readline()
        if not line:
            raise self._ended()
        answer: dict[str, Any] = json.loads(line)
        return answer

    def pause(self) -> None:
        """Stop the program with all of its threads: it takes no time of any processor."""
        self._process.send_signal(signal.SIGSTOP)

    def resume(self) -> None:
        """Let a paused program go on."""
        self._process.send_signal(signal.SIGCONT)

    def close(self) -> None:
        """End the program, also a paused one."""
        self._process.kill()
        self._process.communicate()

    def _ended(self) -> RenderError:
        """An error with the last line of the log."""
        code = self._process.wait()
        said = self._log.read_text(errors="replace").strip().splitlines()
        return RenderError(said[-1] if said else f"it ended with exit code {code}")


def environment_of(checkout: Path, caches: Path) -> dict[str, str]:
    """Environment variables with which Python imports glrt from a checkout.

    The shader caches of drivers are set to `caches`, an empty folder, so that all is compiled.
    """
    path = [str(checkout), *filter(None, [os.environ.get("PYTHONPATH")])]
    return {
        **os.environ,
        "PYTHONPATH": os.pathsep.join(path),
        "MESA_SHADER_CACHE_DIR": str(caches),
        "__GL_SHADER_DISK_CACHE_PATH": str(caches),  # NVIDIA's
    }
