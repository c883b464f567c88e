"""A headless Chromium that a test drives step by step, by the DevTools protocol over pipes."""

import base64
import json
import os
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from tests.support.browser import browser

PATIENCE = 120.0  # seconds until something must be so
# Starts a program that reads from descriptor 3 and writes to 4, as Chromium does with its pipes.
ON_3_AND_4 = """
import fcntl, os, sys
reading, writing = (fcntl.fcntl(int(it), fcntl.F_DUPFD, 10) for it in sys.argv[1:3])
os.dup2(reading, 3)
os.dup2(writing, 4)
os.execv(sys.argv[3], sys.argv[3:])
"""


class Driven:
    """One page of a browser."""

    def __init__(self, reading: int, writing: int, log: Path) -> None:
        self._reading, self._writing, self._log = reading, writing, log
        self._pending, self._number, self._session = b"", 0, ""
        target = self.send("Target.createTarget", url="about:blank")["targetId"]
        self._session = self.send("Target.attachToTarget", targetId=target, flatten=True)[
            "sessionId"
        ]

    def send(self, method: str, **parameters: Any) -> dict[str, Any]:
        """The result of a command; events are dropped. An error fails the test."""
        self._number += 1
        message = {"id": self._number, "method": method, "params": parameters}
        if self._session:
            message["sessionId"] = self._session
        os.write(self._writing, json.dumps(message).encode() + b"\0")
        while True:
            found = self._next()
            if found.get("id") == self._number:
                assert "error" not in found, found
                result: dict[str, Any] = found["result"]
                return result

    def _next(self) -> dict[str, Any]:
        while b"\0" not in self._pending:
            more = os.read(self._reading, 1 << 20)
            assert more, f"the browser has ended: {self._log.read_text()[-2000:]}"
            self._pending += more
        message, _, self._pending = self._pending.partition(b"\0")
        found: dict[str, Any] = json.loads(message)
        return found

    def open(self, address: str, width: int = 1000, height: int = 900) -> None:
        """Open a page, in a window of this size."""
        size = {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": False}
        self.send("Emulation.setDeviceMetricsOverride", **size)
        self.send("Page.navigate", url=address)

    def value(self, expression: str) -> Any:
        """The value of an expression in the page, awaited if it is a promise."""
        options = {"awaitPromise": True, "returnByValue": True}
        found = self.send("Runtime.evaluate", expression=expression, **options)
        assert "exceptionDetails" not in found, found["exceptionDetails"]
        return found["result"].get("value")

    def until(self, expression: str, seconds: float = PATIENCE) -> Any:
        """The value of an expression once it is true."""
        end = time.monotonic() + seconds
        while not (found := self.value(expression)):
            assert time.monotonic() < end, f"{expression} is not true after {seconds:.0f} s"
            time.sleep(0.1)
        return found

    def mouse(self, kind: str, x: float, y: float, **more: Any) -> None:
        """Send an event of the mouse, such as mousePressed, at a place in the window."""
        self.send("Input.dispatchMouseEvent", type=kind, x=x, y=y, **more)

    def screenshot(self, file: Path) -> None:
        """Write a picture of the window, as PNG."""
        file.write_bytes(base64.b64decode(self.send("Page.captureScreenshot")["data"]))


@contextmanager
def driven(profile: Path) -> Iterator[Driven]:
    """A browser with an empty profile in a folder."""
    from_browser, for_it = os.pipe()
    of_browser, to_browser = os.pipe()
    options = ("--no-sandbox", "--disable-gpu", "--remote-debugging-pipe")
    command = [browser(), *options, f"--user-data-dir={profile}", "about:blank"]
    started = [sys.executable, "-c", ON_3_AND_4, str(of_browser), str(for_it), *command]
    log = profile.with_suffix(".log")
    errors = log.open("wb")
    process = subprocess.Popen(started, pass_fds=(of_browser, for_it), stderr=errors)
    os.close(of_browser)
    os.close(for_it)
    try:
        yield Driven(from_browser, to_browser, log)
    finally:
        process.kill()
        process.wait()
        errors.close()
        os.close(from_browser)
        os.close(to_browser)
