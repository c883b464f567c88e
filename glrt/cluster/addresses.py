"""Where a cluster is: processes of this machine, an address, or the file of a scheduler."""

from dataclasses import dataclass
from typing import Literal

from glrt.core.text import quoted

MOST_LOCAL = 256  # processes
LOCAL = "local:"
_SCHEMES = ("tcp://", "tls://")


@dataclass(frozen=True)
class Address:
    """A cluster, as the user named it."""

    kind: Literal["local", "scheduler", "file"]
    text: str
    count: int = 0  # processes of a local one


def parse_address(text: str) -> Address:
    """Return the cluster of a name; ValueError says what is wrong."""
    if text.startswith(LOCAL):
        count = text.removeprefix(LOCAL)
        if not count.isdecimal() or not 1 <= int(count) <= MOST_LOCAL:
            raise ValueError(f"{quoted(text)}: local:N needs a number from 1 to {MOST_LOCAL}")
        return Address("local", text, int(count))
    if "://" not in text:
        if not text:
            raise ValueError("a cluster is local:N, tcp://HOST:PORT or the file of a scheduler")
        return Address("file", text)
    host, _, port = text.partition("://")[2].rpartition(":")
    if not text.startswith(_SCHEMES) or not host or not port.isdecimal():
        raise ValueError(f"{quoted(text)} is not tcp://HOST:PORT, such as tcp://10.0.0.1:8786")
    return Address("scheduler", text)
