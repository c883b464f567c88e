"""Handles in the picture that move, turn and scale the selected object."""

from imgui_bundle import imgui
from imgui_bundle.imguizmo import im_guizmo

from glrt.scene.shapes.kinds import Shape
from glrt.view.app import App
from glrt.view.viewport.transform import (
    can_turn,
    moved_to,
    object_matrix,
    projection_matrix,
    view_matrix,
    with_moved,
)


def draw_gizmo(app: App, left: float, top: float, width: float, height: float) -> None:
    """Draw the handles; the rectangle is that of the picture on the screen, in pixels."""
    shape = app.selected_shape
    if shape is None or app.is_locked or app.paths.is_choosing:  # a click chooses the pixel
        return
    settings = app.session.settings
    im_guizmo.begin_frame()
    im_guizmo.set_drawlist()
    im_guizmo.set_rect(left, top, width, height)
    matrix = im_guizmo.Matrix16(object_matrix(shape))
    changed = im_guizmo.manipulate(
        im_guizmo.Matrix16(view_matrix(app.camera)),
        im_guizmo.Matrix16(projection_matrix(app.camera, settings.width / settings.height)),
        _operation(app, shape),
        im_guizmo.MODE.world,
        matrix,
    )
    if changed and app.selected is not None:
        index, values, chosen = app.selected, matrix.values, app.chosen
        app.edit_scene(
            f"object {index}",
            lambda scene: with_moved(scene, index, moved_to(shape, values), chosen),
        )


def _operation(app: App, shape: Shape) -> im_guizmo.OPERATION:
    """Return what the handles do: a shape without size is not scaled, and a ball is not turned."""
    if imgui.get_io().key_shift and (shape.extents or shape.points):
        return im_guizmo.OPERATION.scale
    if app.handles == "turn" and can_turn(shape):
        return im_guizmo.OPERATION.rotate
    return im_guizmo.OPERATION.translate


def is_held(app: App) -> bool:
    """Whether the mouse is over or drags the handles, so that it does not move the camera."""
    if app.selected_shape is None or app.is_locked or app.paths.is_choosing:
        return False
    return bool(im_guizmo.is_using() or im_guizmo.is_over())
