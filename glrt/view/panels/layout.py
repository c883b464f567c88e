"""The parts of the window: their shares of it, and the ground below them."""

from collections.abc import Callable
from functools import partial

from imgui_bundle import ImVec2, hello_imgui, imgui

from glrt.view.style import opaque


class Shares:
    """Keeps the shares when the window is resized; otherwise only the picture would change."""

    def __init__(self) -> None:
        """Begin without a known size of the window."""
        self._size = (0.0, 0.0)

    def keep(self, names: tuple[str, ...]) -> None:
        """Scale the parts of these names if the window was resized; call it once a frame.

        Parts without a size are skipped: a saved layout has no sizes before its first frame.
        """
        size = imgui.get_io().display_size.x, imgui.get_io().display_size.y
        before, self._size = self._size, size
        if size == before or not all((*size, *before)):
            return
        scale = ImVec2(size[0] / before[0], size[1] / before[1])
        for node in _nodes(names):
            wanted = node.size_ref * scale
            if wanted.x > 0 and wanted.y > 0:
                imgui.internal.dock_builder_set_node_size(node.id_, wanted)


def _nodes(names: tuple[str, ...]) -> list[imgui.internal.DockNode]:
    """Return the nodes where these parts are docked, and the splits around them except the root."""
    found: dict[int, imgui.internal.DockNode] = {}
    for name in names:
        part = imgui.internal.find_window_by_name(name)
        node = part.dock_node if part else None
        while node and node.parent_node:
            found[node.id_] = node
            node = node.parent_node
    return list(found.values())


def window_part(label: str, place: str, draw: Callable[[], None]) -> hello_imgui.DockableWindow:
    """Return a part of the window that lies at a place of its layout."""
    made = hello_imgui.DockableWindow()
    made.label, made.dock_space_name = label, place
    made.gui_function = partial(draw_on_ground, draw)
    made.imgui_window_flags = imgui.WindowFlags_.no_background
    made.can_be_closed = False
    return made


def draw_on_ground(draw: Callable[[], None]) -> None:
    """Draw a part of the window, whose ground is the colour that each frame begins with.

    A ground of its own, blended, would take a third of the frame without a GPU. A part that was
    moved out of the window's layout gets one: it may lie over others.
    """
    node = imgui.internal.get_current_window().dock_node
    if not node or not imgui.internal.dock_node_get_root_node(node).is_dock_space():
        color = imgui.get_color_u32(opaque(imgui.get_style().color_(imgui.Col_.window_bg)))
        corner, size = imgui.get_window_pos(), imgui.get_window_size()
        imgui.get_window_draw_list().add_rect_filled(corner, corner + size, color)
    draw()
