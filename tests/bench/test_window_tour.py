"""The scripted window reports what was measured."""

from bench.window_tour import Frame, Wait, rest_text, told


def test_a_drag_is_reported_by_percentiles_and_by_what_was_seen_meanwhile() -> None:
    frames = [Frame(0.001 * n, (320, 240), 1.5) for n in range(1, 101)]
    head, _, row = told("cornell", frames)
    assert "100 frames" in head
    assert row.startswith("| cornell | 50 ms | 95 ms | 99 ms | 320 x 240 pixels, 1.5 samples")


def test_a_rest_is_reported_by_its_end_its_rate_and_its_frames() -> None:
    frames = [0.001 * n for n in range(1, 102)]
    waits = [Wait(False, 52.3, 1.824, frames), Wait(True, 17.2, 5.75, frames)]
    _, _, *rows = rest_text("cornell", waits)
    assert rows == [
        "| without | 52.3 s | 1.82 | 51 ms | 100 ms | 101 ms |",
        "| with the faster kernel | 17.2 s | 5.75 | 51 ms | 100 ms | 101 ms |",
    ]
