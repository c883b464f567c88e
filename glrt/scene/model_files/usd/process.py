"""Run the conversion of a USD file in a process of its own, which may crash or hang."""

import json
import os
import subprocess
import sys
import tempfile
from importlib.util import find_spec
from pathlib import Path

from glrt.core.errors import ContentError
from glrt.core.install import install

SUFFIXES = (".usd", ".usda", ".usdc", ".usdz")
_MODULE = "glrt.scene.model_files.usd.conversion"
_PATIENCE, _PATIENCE_PER_BYTE = 60.0, 2e-6  # seconds: for any file, and for each byte of it
_FOREIGN = ("PXR_", "USD_", "TF_", "AR_")  # variables that change what the library does


class ConversionError(ContentError):
    """A USD file was not converted; the message completes `FILE ...`, without a full stop."""


def is_usd(path: str) -> bool:
    """Return whether the name of a file is that of a USD file."""
    return path.lower().endswith(SUFFIXES)


def glb_of(file: Path, base: Path, allow_outside: bool) -> bytes:
    """Return the content of a .glb file with what a USD file shows; raises `ConversionError`.

    Layers outside of the folder `base` are left out, unless `allow_outside`.
    """
    if find_spec("pxr") is None or getattr(sys, "frozen", False):  # sys.executable is no Python
        raise ConversionError(
            "is a USD file, and usd-core, which reads it, is not installed. Install it by: "
            f"{install('usd')}"
        )
    with tempfile.TemporaryDirectory(prefix="glrt-usd-") as place:
        output = Path(place) / "made.glb"
        arguments = [file.absolute(), base.absolute(), allow_outside, output]
        command = [sys.executable, "-P", "-m", _MODULE, *map(str, arguments)]
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
            raise ConversionError("is damaged, or no USD file. Export it again")
        content = output.read_bytes()
    if content[:4] != b"glTF":
        raise ConversionError(f"{json.loads(content)['problem']}. Export it again")
    return content


def _environment(place: str) -> dict[str, str]:
    """Return the variables of the process: its files lie in `place`, also those of a crash."""
    kept = {key: it for key, it in os.environ.items() if not key.startswith(_FOREIGN)}
    path = os.pathsep.join(os.path.abspath(entry) for entry in sys.path)
    return {**kept, "PYTHONPATH": path, "TMPDIR": place}
