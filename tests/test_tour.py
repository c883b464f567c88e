"""The scripted window tells what was measured."""

from glrt.ui.tour import Frame, told


def test_a_drag_is_told_by_percentiles_and_by_what_was_seen_meanwhile() -> None:
    frames = [Frame(0.001 * n, (320, 240), 1.5) for n in range(1, 101)]
    head, _, row = told("cornell", frames)
    assert "100 frames" in head
    assert row.startswith("| cornell | 50 ms | 95 ms | 99 ms | 320 x 240 pixels, 1.5 samples")
