"""Run the conversion of a file in a process of its own, which may crash or hang."""

import json
import os
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path

from glrt.core.errors import ContentError
from glrt.core.install import install

_PATIENCE, _PATIENCE_PER_BYTE = 60.0, 2e-6  # seconds: for any file, and for each byte of it
# variables that change what the libraries do
_FOREIGN = ("PXR_", "USD_", "TF_", "AR_", "MATERIALX_")


@dataclass(frozen=True)
class Library:
    """A library that reads files of a kind."""

    suffixes: tuple[str, ...]
    kind: str  # what a file is
    package: str  # as Python imports it
    name: str  # under which pip knows it
    extra: str  # of glrt, which installs it
    module: str  # that is run


LIBRARIES = (
    Library(
        (".usd", ".usda", ".usdc", ".usdz"),
        "USD file",
        "pxr",
        "usd-core",
        "usd",
        "glrt.scene.model_files.usd.conversion",
    ),
    Library(
        (".mtlx",),
        "MaterialX file",
        "MaterialX",
        "materialx",
        "materialx",
        "glrt.scene.model_files.materialx.conversion",
    ),
)
SUFFIXES = tuple(suffix for library in LIBRARIES for suffix in library.suffixes)


class ConversionError(ContentError):
    """A file was not converted; the message completes `FILE ...`, without a full stop."""


def library_of(path: str) -> Library | None:
    """Return the library that reads a file with this name; None if glrt itself does."""
    return next((it for it in LIBRARIES if path.lower().endswith(it.suffixes)), None)


def glb_of(library: Library, file: Path, base: Path, allow_outside: bool) -> bytes:
    """Return the content of a .glb file with what a file shows; raises `ConversionError`.

    Files that it names outside of the folder `base` are left out, unless `allow_outside`.
    """
    if find_spec(library.package) is None or getattr(sys, "frozen", False):
        raise ConversionError(  # a frozen program has no Python in sys.executable
            f"is a {library.kind}, and {library.name}, which reads it, is not installed. Install "
            f"it by: {install(library.extra)}"
        )
    with tempfile.TemporaryDirectory(prefix="glrt-convert-") as place:
        output = Path(place) / "made.glb"
        arguments = [file.absolute(), base.absolute(), allow_outside, output]
        command = [sys.executable, "-P", "-m", library.module, *map(str, arguments)]
        patience = _PATIENCE + _PATIENCE_PER_BYTE * file.stat().st_size
        nowhere = subprocess.DEVNULL
        try:
            done = subprocess.run(
                command,
                stdin=nowhere,
                stdout=nowhere,
                stderr=nowhere,
                timeout=patience,
                env=_environment(place),
                cwd=place,
            )
        except subprocess.TimeoutExpired:
            raise ConversionError(
                f"is damaged, or too large: it cannot be read in {patience:.0f} s. Export it again"
            ) from None
        if done.returncode != 0 or not output.is_file():
            raise ConversionError(f"is damaged, or no {library.kind}. Export it again")
        content = output.read_bytes()
    if content[:4] != b"glTF":
        raise ConversionError(f"{json.loads(content)['problem']}. Export it again")
    return content


def _environment(place: str) -> dict[str, str]:
    """Return the variables of the process: its files lie in `place`, also those of a crash."""
    kept = {key: it for key, it in os.environ.items() if not key.startswith(_FOREIGN)}
    path = os.pathsep.join(os.path.abspath(entry) for entry in sys.path)
    return {**kept, "PYTHONPATH": path, "TMPDIR": place}
