"""A USD file as the content of a .glb file: `python -m` this, in a process of its own."""

import sys

import numpy as np
from pxr import Usd, UsdGeom

from glrt.scene.model_files.conversion.folder import Folder
from glrt.scene.model_files.conversion.outcome import convert, put_tables
from glrt.scene.model_files.conversion.reports import LeftOut
from glrt.scene.model_files.gltf_file import GltfFile
from glrt.scene.model_files.usd.images import Images
from glrt.scene.model_files.usd.lamps import Lamps
from glrt.scene.model_files.usd.layers import opened_stage
from glrt.scene.model_files.usd.looks import Looks
from glrt.scene.model_files.usd.motion import Motion
from glrt.scene.model_files.usd.placing import Placing
from glrt.scene.model_files.usd.primitives import Primitives

_Y_FROM_Z = np.array([[1.0, 0, 0, 0], [0, 0, 1, 0], [0, -1, 0, 0], [0, 0, 0, 1]])


def converted(folder: Folder) -> bytes:
    """Return the content of a .glb file, whose extras hold what glTF cannot.

    Raises `UnshownError`.
    """
    left = folder.left
    stage = opened_stage(folder)
    time = _moment(stage, left)
    glb = GltfFile("glrt")
    images = Images(glb, folder, time)
    looks, lamps = Looks(images, left, time), Lamps(left, images, time)
    unit = UsdGeom.GetStageMetersPerUnit(stage)
    if not 1e-12 < unit < 1e12:
        left.add("metersPerUnit")
        unit = 1.0
    frame = np.diag([unit, unit, unit, 1.0])
    if UsdGeom.GetStageUpAxis(stage) == "Z":
        frame = _Y_FROM_Z @ frame
    motion = Motion(stage, frame, left, not time.IsDefault())
    placing = Placing(glb, Primitives(glb, looks, left, time), lamps, motion, left, time)
    placing.place(stage, frame, unit)
    for number, node in enumerate(placing.nodes):
        assert glb.add("nodes", node) == number
    motion.add_to(glb)
    glb.add("scenes", {"nodes": list(range(len(placing.nodes)))})
    for look in looks.found:
        glb.add("materials", {"name": look.name})
    tables = [{"table": it.table, "is_two_sided": it.is_two_sided} for it in looks.found]
    put_tables(glb, folder, tables, lamps.tables, placing.lenses)
    return glb.binary()


def _moment(stage: Usd.Stage, left: LeftOut) -> Usd.TimeCode:
    """Return the moment at which a file is shown: its first; with clips, that of no samples."""
    has_clips, changing = False, set[str]()
    for prim in stage.Traverse():
        has_clips |= prim.HasAuthoredMetadata("clips")
        for it in prim.GetAuthoredAttributes():
            if it.GetNumTimeSamples() > 1 and not it.GetName().startswith("xformOp:"):
                changing.add(it.GetName())
    if has_clips:
        left.add("value clips")
        return Usd.TimeCode.Default()
    for name in sorted(changing):
        left.name("changes over time of", name)
    if stage.HasAuthoredTimeCodeRange():
        return Usd.TimeCode(stage.GetStartTimeCode())
    return Usd.TimeCode.EarliestTime()


if __name__ == "__main__":
    sys.exit(convert(converted))
