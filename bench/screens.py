"""Virtual X servers, Xvfb, which need no screen."""

import os
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def screen(size: str = "64x64", *options: str) -> Iterator[str]:
    """Start an X server with a screen of this size; yield its display name, such as ":1".

    `options` are more of Xvfb's.
    Xvfb is run directly, since xvfb-run also needs xauth.
    """
    told, end = os.pipe()
    command = ["Xvfb", "-displayfd", str(end), "-screen", "0", f"{size}x24", "-nolisten", "tcp"]
    command += options
    with subprocess.Popen(command, pass_fds=[end], stderr=subprocess.DEVNULL) as server:
        os.close(end)
        try:
            with os.fdopen(told) as numbers:
                yield f":{numbers.readline().strip()}"
        finally:
            server.terminate()
