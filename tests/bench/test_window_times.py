"""Times of the window as a table, and the large model that they are measured on."""

from pathlib import Path

import numpy as np

from bench.window_times import SIZES, STOPS, Times, head, row, stop_row, write_torus
from glrt.image.sources import load


def test_a_row_names_scene_and_size_and_has_a_cell_for_each_column() -> None:
    *_, names, line = head(19.44)
    cells = row("scenes/models/cow.glb", SIZES[0], Times(1.204, 3.2, 0.456, 12.34))
    assert cells == "| cow.glb | 1240x800 | 1.20 s | 3.20 s | 0.46 s | 12.3 |"
    assert names.count("|") == line.count("|") == cells.count("|")


def test_a_row_of_stops_has_a_cell_for_each_column() -> None:
    *_, names, line = head(1.0, STOPS)
    cells = stop_row("scenes/models/cow.glb", SIZES[0], "save", 0.312, 0.104)
    assert cells == "| cow.glb | 1240x800 | save | 0.31 s | 0.10 s |"
    assert names.count("|") == line.count("|") == cells.count("|")


def test_the_load_stands_above_the_table() -> None:
    assert next(head(19.44)).endswith(" processors, load 19.4\n")


def test_the_large_model_is_a_closed_ring_that_faces_outwards(tmp_path: Path) -> None:
    file = tmp_path / "large.ply"
    write_torus(file, 12)
    mesh = load(str(file)).meshes[0].triangles
    assert len(mesh.faces) == 288
    assert mesh.opening == ""
    a, b, c = mesh.vertices[mesh.faces].swapaxes(0, 1)
    volume = np.einsum("ij,ij", a, np.cross(b, c)) / 6
    assert 0.5 * 2 * np.pi**2 * 0.4**2 < volume < 1.2 * 2 * np.pi**2 * 0.4**2
