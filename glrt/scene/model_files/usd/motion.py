"""Motion of things in a USD file, as an animation of a glTF file."""

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pxr import Gf, Usd, UsdGeom

from glrt.scene.model_files.conversion.reports import LeftOut
from glrt.scene.model_files.gltf_file import GltfFile, Table

Matrices = NDArray[np.float64]  # (k, 4, 4), which turn columns

NAME = "time"  # of the animation
_USUAL_RATE = 24.0  # time codes a second
_MOST_KEYS = 10_000  # of a file, in time
_MOST_PLACES = 2_000_000  # of all things at all keys
_SKEWED = 1e-4  # largest cosine between axes that counts as a right angle


class Motion:
    """The moments of a file, and how its things move: by keys at each time code.

    Transforms are sampled at whole time codes. So a turn by more than half a circle between two
    samples of the file keeps its way.
    """

    def __init__(self, stage: Usd.Stage, frame: Matrices, left: LeftOut, moves: bool) -> None:
        """`frame` leads to the scene; without `moves`, everything stands still."""
        self._frame, self._left = frame, left
        rate = stage.GetTimeCodesPerSecond()
        rate = rate if math.isfinite(rate) and rate > 0 else _USUAL_RATE
        start, end = _range(stage) if moves else (0.0, 0.0)
        codes: list[float] = []
        if 0 < end - start < _MOST_KEYS:
            codes = [start, *range(math.floor(start) + 1, math.ceil(end)), end]
        elif end > start:
            left.add(f"motion over more than {_MOST_KEYS:,} time codes")
        self._caches = [UsdGeom.XformCache(Usd.TimeCode(code)) for code in codes]
        self._seconds = (np.array(codes) - start) / rate
        self._found: list[tuple[int, Matrices]] = []
        self._count = 0

    def keys(self, prim: Usd.Prim) -> Matrices | None:
        """Return where a prim stands at each moment, in the scene; None if it stands still."""
        if not self._caches or not _may_move(prim):
            return None
        self._count += len(self._caches)
        if self._count > _MOST_PLACES:
            self._left.add("motion of so many things")
            return None
        places = [_array(cache.GetLocalToWorldTransform(prim)) for cache in self._caches]
        matrices: Matrices = self._frame @ np.array(places)
        if not np.isfinite(matrices).all() or np.array_equal(matrices, matrices[:1] + 0 * matrices):
            return None
        return matrices

    def start(self, table: Table, number: int, matrices: Matrices) -> None:
        """Let the node `number` begin at the first of its places, and move through all of them."""
        parts = _parts(matrices)
        if parts is None:
            self._left.add("motion that skews or flattens things")
            table["matrix"] = matrices[0].T.ravel().tolist()
            return
        self._found.append((number, matrices))
        table.update({path: values[0].tolist() for path, values in parts.items()})

    def add_to(self, glb: GltfFile) -> None:
        """Add the animation to a file, if anything moves."""
        if not self._found:
            return
        times = glb.vertices(self._seconds[:, None])
        samplers: list[Table] = []
        channels: list[Table] = []
        for node, matrices in self._found:
            for path, values in (_parts(matrices) or {}).items():
                if np.array_equal(values, np.broadcast_to(values[0], values.shape)):
                    continue
                channels.append({"sampler": len(samplers), "target": {"node": node, "path": path}})
                samplers.append({"input": times, "output": glb.vertices(values)})
        glb.add("animations", {"name": NAME, "samplers": samplers, "channels": channels})


def _range(stage: Usd.Stage) -> tuple[float, float]:
    """Return the first and the last time code: as the file says, else those of its transforms."""
    if stage.HasAuthoredTimeCodeRange():
        return stage.GetStartTimeCode(), stage.GetEndTimeCode()
    places = (UsdGeom.Xformable(prim) for prim in stage.Traverse())
    codes = [code for place in places if place for code in place.GetTimeSamples()]
    return (min(codes), max(codes)) if codes else (0.0, 0.0)


def _may_move(prim: Usd.Prim) -> bool:
    while prim and not prim.IsPseudoRoot():
        place = UsdGeom.Xformable(prim)
        if place and place.TransformMightBeTimeVarying():
            return True
        prim = prim.GetParent()
    return False


def _array(matrix: Gf.Matrix4d) -> NDArray[np.float64]:
    return np.array(matrix, np.float64).T


def _parts(matrices: Matrices) -> dict[str, NDArray[np.float64]] | None:
    """Return translations (k, 3), rotations (k, 4) and scales (k, 3) whose product they are."""
    axes = matrices[:, :3, :3]
    scales = np.linalg.norm(axes, axis=1)
    if not (scales > 0).all():
        return None
    turns = axes / scales[:, None, :]
    mirrored = np.linalg.det(turns) < 0
    scales[mirrored, 0] *= -1
    turns[mirrored, :, 0] *= -1
    skew = np.abs(turns.transpose(0, 2, 1) @ turns - np.eye(3)).max()
    if skew > _SKEWED:
        return None
    return {
        "translation": matrices[:, :3, 3],
        "rotation": _steady(np.array([_quaternion(turn) for turn in turns])),
        "scale": scales,
    }


def _quaternion(turn: NDArray[np.float64]) -> Any:
    found = Gf.Matrix3d(turn.T.tolist()).ExtractRotation().GetQuat()
    return [*found.GetImaginary(), found.GetReal()]


def _steady(quaternions: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the same rotations, each on the side of the sphere where the one before is."""
    turns = np.sum(quaternions[1:] * quaternions[:-1], axis=1) < 0
    signs = np.cumprod(np.concatenate([[1.0], np.where(turns, -1.0, 1.0)]))
    return quaternions * signs[:, None]
