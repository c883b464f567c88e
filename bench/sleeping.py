"""A job for the workers of a cluster whose tasks take time and no processor."""

import time
from typing import NamedTuple

FRAME = 3_000_000  # bytes that a task sends back: an EXR file of 512 x 512 pixels with its errors


class Sleep(NamedTuple):
    """A job whose tasks take their time and no processor."""

    seconds: float

    def begin(self) -> "Sleep":
        """Return the work, which is the job."""
        return self

    def do(self, number: int) -> bytes:
        """Sleep, and return the content of a frame."""
        time.sleep(self.seconds)
        return number.to_bytes(4, "little") * (FRAME // 4)

    def release(self) -> None:
        """Nothing was taken."""
