r"""Names of files as text that scenes, recipes and messages can hold.

Most systems allow any bytes in a name. The text is the name in UTF-8, whatever the locale; a byte
that is no UTF-8, a control character and a backslash stand in it as `\xHH`.
"""

import os
import re

_CONTROL = re.compile(rb"[\x01-\x1f\x7f]")
# A backslash comes out of a text only where it does not divide folders.
_ESCAPE = re.compile(
    rb"\\x(0[1-9a-f]|1[0-9a-f]|7f|[89a-f][0-9a-f]" + b"|5c" * (os.sep == "/") + rb")"
)


def text_of(name: str) -> str:
    """Return the text of a name or path that the system gave; `name_of` undoes it."""
    return text_of_bytes(os.fsencode(name).replace(b"\\", rb"\x5c"))


def text_of_bytes(path: bytes) -> str:
    """Return the text of a path in a file; its backslashes stay, since they divide no folders."""
    content = _CONTROL.sub(lambda byte: rb"\x%02x" % byte[0][0], path)
    return content.decode("utf-8", "backslashreplace")


def name_of(text: str) -> str:
    """Return the name or path of a text, as the system takes it; ValueError if it cannot be one."""
    return os.fsdecode(_ESCAPE.sub(lambda found: bytes.fromhex(found[1].decode()), text.encode()))


def has_stray_backslash(text: str) -> bool:
    r"""Return whether there is a backslash that is not part of a `\xHH`."""
    return b"\\" in _ESCAPE.sub(b"", text.encode())


def with_slashes(text: str) -> str:
    """Return a path with '/' in place of Windows' backslashes, those of `\\xHH` excepted."""
    folders = re.sub(rb"(%b)|\\" % _ESCAPE.pattern, lambda found: found[1] or b"/", text.encode())
    return folders.decode()
