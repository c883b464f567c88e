"""The shares of the window's parts, where Dear ImGui has not given all of them a size."""

from types import SimpleNamespace
from typing import Any

import pytest
from imgui_bundle import ImVec2

from glrt.view.panels import layout


def test_a_part_without_a_size_yet_is_left_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    """This happens after the start with a saved layout: a size of 0 would end the window."""
    sizes: dict[int, ImVec2] = {}
    io = SimpleNamespace(display_size=ImVec2(800, 600))
    internal = SimpleNamespace(dock_builder_set_node_size=sizes.__setitem__)
    monkeypatch.setattr(layout, "imgui", SimpleNamespace(get_io=lambda: io, internal=internal))
    refs = {1: ImVec2(200, 600), 2: ImVec2(0, 0), 3: ImVec2(600, 0)}
    nodes: list[Any] = [SimpleNamespace(id_=number, size_ref=size) for number, size in refs.items()]
    monkeypatch.setattr(layout, "_nodes", lambda _: nodes)
    shares = layout.Shares()
    shares.keep(("Picture",))
    assert sizes == {}
    io.display_size = ImVec2(400, 300)
    shares.keep(("Picture",))
    assert {number: (size.x, size.y) for number, size in sizes.items()} == {1: (100, 300)}
