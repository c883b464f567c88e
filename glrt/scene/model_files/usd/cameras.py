"""Cameras of a USD file: as those of a glTF file, and their lenses as keys of a scene."""

import math

from pxr import Usd, UsdGeom

from glrt.scene.model_files.conversion.reports import LeftOut
from glrt.scene.model_files.gltf_file import Table

_TENTH = 0.1  # focal lengths and apertures are in tenths of a unit of the file
_MOST_ANGLE = 170.0  # degrees of a lens, seen from the point in focus
_NARROWEST, _WIDEST = 1e-3, 3.1  # radians
_LEAST_ASPECT, _MOST_ASPECT = 0.05, 20.0


def camera_table(prim: Usd.Prim, time: Usd.TimeCode, left: LeftOut) -> Table | None:
    """Return a camera as a table of a glTF file; None for one by which nothing can be seen."""
    camera = UsdGeom.Camera(prim)
    if camera.GetProjectionAttr().Get(time) == "orthographic":
        return {"type": "orthographic"}
    focal, across, up = (
        float(it.Get(time))
        for it in (
            camera.GetFocalLengthAttr(),
            camera.GetHorizontalApertureAttr(),
            camera.GetVerticalApertureAttr(),
        )
    )
    offsets = camera.GetHorizontalApertureOffsetAttr(), camera.GetVerticalApertureOffsetAttr()
    if any(it.Get(time) for it in offsets):
        left.add("shifted lenses of cameras")
    exposure = camera.GetExposureAttr().Get(time)
    if exposure:
        left.add("exposure of cameras")
    if not (focal > 0 and across > 0 and up > 0):
        left.add("cameras without a field of view")
        return None
    angle = 2 * math.atan(up / 2 / focal)
    aspect = across / up
    if not (_NARROWEST <= angle <= _WIDEST and _LEAST_ASPECT <= aspect <= _MOST_ASPECT):
        left.add("cameras of extreme fields of view")
        return None
    return {"type": "perspective", "perspective": {"yfov": angle, "aspectRatio": aspect}}


def lens_table(prim: Usd.Prim, time: Usd.TimeCode, unit: float) -> Table:
    """Return the focus as keys of a scene's camera; `unit`: units of the scene in one of the file.

    The lens has the diameter of the focal length over the f-number; an f-number of 0 is a pinhole.
    """
    camera = UsdGeom.Camera(prim)
    stop, distance = camera.GetFStopAttr().Get(time), camera.GetFocusDistanceAttr().Get(time)
    if not (distance and distance > 0 and math.isfinite(distance)):
        return {}
    found = {"focus_distance": float(distance) * unit}
    if stop and stop > 0:
        radius = float(camera.GetFocalLengthAttr().Get(time)) * _TENTH / float(stop) / 2
        angle = math.degrees(2 * math.atan(radius / float(distance)))
        found["defocus_angle"] = min(angle, _MOST_ANGLE)
    return found
