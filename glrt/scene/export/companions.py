"""Files that lie in a folder next to a scene file: triangles, images, voxels.

They are named by their content. So a scene that is exported again never changes a file that
another scene names, and equal content is written once.
"""

import hashlib
import re
import struct
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from glrt.core.files import check_writable, make_folder, write_whole
from glrt.scene.export.image_codes import MOST, codes_of, png_of
from glrt.scene.export.meshes import Form
from glrt.scene.images.codes import decode_srgb

_NAME = 16  # digits of a hash in a name


class Companions:
    """The files of one scene."""

    def __init__(self, output: Path) -> None:
        """Their folder has the name of the scene file; signs that a format may not take are `_`."""
        self.folder = f"{re.sub(r'[^A-Za-z0-9._-]', '_', output.stem)}-files"
        self._base, self._files = output.parent, dict[str, bytes]()

    @property
    def count(self) -> int:
        """Number of the files."""
        return len(self._files)

    def add(self, kind: str, suffix: str, content: bytes) -> str:
        """Add a file; return its path from the scene file."""
        name = f"{self.folder}/{kind}-{hashlib.sha256(content).hexdigest()[:_NAME]}{suffix}"
        self._files[name] = content
        return name

    def save(self) -> int:
        """Write all files; return their bytes.

        Raises UsageError before the first one if a file cannot be written, and RenderError if
        writing fails.
        """
        if self._files:
            make_folder(self._base / self.folder)
        for name in self._files:
            check_writable(self._base / name)
        for name, content in self._files.items():
            _save(self._base / name, content)
        return sum(map(len, self._files.values()))


def _save(path: Path, content: bytes) -> None:
    write_whole(path, lambda file: _write(file, content))


def _write(file: Path, content: bytes) -> None:
    file.write_bytes(content)


def ply_of(form: Form) -> bytes:
    """Return a binary PLY file; coordinates of texture are `u` and `v`, as they are given."""
    parts = {"x y z": form.points, "nx ny nz": form.normals, "u v": form.uv}
    given = {names: values for names, values in parts.items() if values is not None}
    names = " ".join(given).split()
    rows = np.concatenate([np.asarray(it, np.float64) for it in given.values()], axis=1)
    faces = np.empty(len(form.faces), [("count", "u1"), ("corners", "<i4", 3)])
    faces["count"], faces["corners"] = 3, form.faces
    head = ["ply", "format binary_little_endian 1.0", f"element vertex {len(rows)}"]
    head += [f"property float {name}" for name in names]
    head += [f"element face {len(faces)}", "property list uchar int vertex_indices", "end_header"]
    return "\n".join([*head, ""]).encode() + rows.astype("<f4").tobytes() + faces.tobytes()


def pfm_of(pixels: NDArray[Any]) -> bytes:
    """Return a Portable Float Map of linear pixels, (H, W, 1 or 3), row 0 on top."""
    height, width, channels = pixels.shape
    head = f"{'PF' if channels == 3 else 'Pf'}\n{width} {height}\n-1.0\n"
    return head.encode() + np.ascontiguousarray(pixels[::-1], "<f4").tobytes()


def exact_png(pixels: NDArray[Any]) -> bytes | None:
    """Return a PNG file, in sRGB, of linear colours, (H, W, 3); None if it would change one."""
    codes = codes_of(pixels, True)
    decoded = decode_srgb(np.arange(MOST + 1) / MOST).astype(np.float16)[codes]
    return png_of(codes) if np.array_equal(decoded, pixels.astype(np.float16)) else None


def vol_of(voxels: NDArray[Any]) -> bytes:
    """Return a .vol file of Mitsuba, of voxels (z, y, x, channels) in the unit cube."""
    deep, high, wide, channels = voxels.shape
    version, is_float = 3, 1
    head = b"VOL" + struct.pack("<B5i6f", version, is_float, wide, high, deep, channels, *_UNIT)
    return head + np.ascontiguousarray(voxels, "<f4").tobytes()


_UNIT = 0.0, 0.0, 0.0, 1.0, 1.0, 1.0
