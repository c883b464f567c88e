"""Shares of the window that its parts fill."""

from imgui_bundle import ImVec2, imgui


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
