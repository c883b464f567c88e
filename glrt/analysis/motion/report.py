"""The chart of error while something moves: SVG, PNG, CSV, and pages."""

import csv
import io
from collections.abc import Iterator, Sequence
from pathlib import Path

from glrt.analysis.chart_page import Section, Table, axes_of
from glrt.analysis.motion.measure import BEFORE, DEGREES, FACTOR, FRAMES, Track
from glrt.analysis.plot import FORMATS, Chart, Curve, save_sheet
from glrt.core import files

PAGE = "temporal.md"
HEADINGS = ("scene", "sequence", "mode", "frame", "rays", "error")
CLOCK = "milliseconds"  # the heading of one more column: median of a frame
_WORDS = {
    "orbit": f"orbit, {DEGREES:g} degree a frame",
    "light step": f"light dimmed to {FACTOR:.0%} after {BEFORE} frames",
}


def save_tracks(name: str, title: str, tracks: Sequence[Track], folder: Path) -> None:
    """Write NAME.temporal.svg, .png and .csv."""
    charts = _charts(tracks)
    for suffix in FORMATS:
        save_sheet(charts, folder / f"{name}.temporal{suffix}", title, columns=2)
    text = io.StringIO()
    table = csv.writer(text, lineterminator="\n")
    table.writerow([*HEADINGS, *([CLOCK] if _is_timed(tracks) else [])])
    table.writerows(rows(tracks))
    files.write_text(folder / f"{name}.temporal.csv", text.getvalue())


def rows(tracks: Sequence[Track]) -> Iterator[tuple[object, ...]]:
    """A row for each look, under HEADINGS; then the track's milliseconds, where it is timed."""
    for track in tracks:
        time = [f"{track.milliseconds.value:.4g}"] if track.milliseconds else []
        for seen in track.seen:
            place = track.scene, track.sequence, track.mode, seen.frame
            yield (*place, round(seen.rays, 3), f"{seen.error:.5g}", *time)


def save_page(tracks: Sequence[Track], size: str, folder: Path) -> Path:
    """Write the page with the means of all scenes, and return its path."""
    path = folder / PAGE
    files.write_text(path, "\n".join(_lines(tracks, size)) + "\n")
    return path


def section_of(name: str, title: str, tracks: Sequence[Track]) -> Section:
    """The section of a scene on a page that needs no network; `tracks` are the scene's."""
    charts = _charts(tracks)
    timed = ["milliseconds a frame"] if _is_timed(tracks) else []
    rows = [["what moves, mode", "rays a pixel and frame", "mean error", *timed]]
    rows += [
        [
            f"{_WORDS[track.sequence]}, {track.mode}",
            f"{_rays(track):.1f}",
            f"{track.mean_error:.3f}",
            *([_time(track)] if timed else []),
        ]
        for track in tracks
    ]
    axes = [axes_of(chart, chart.title) for chart in charts]
    about = f"Over {FRAMES} frames of one sample a pixel."
    return Section(name, f"{name}: {title}", [about], axes, [Table("means", rows)])


def _rays(track: Track) -> float:
    return sum(seen.rays for seen in track.seen) / len(track.seen)


def _is_timed(tracks: Sequence[Track]) -> bool:
    return any(track.milliseconds for track in tracks)


def _time(track: Track) -> str:
    """Median and quartiles of the milliseconds of a frame."""
    if not track.milliseconds:
        return "-"
    median, low, high = (f"{value:.3g}" for value in track.milliseconds)
    return f"{median} ({low}-{high})"


def _lines(tracks: Sequence[Track], size: str) -> Iterator[str]:
    yield "# Error while something moves"
    yield ""
    yield (
        "Written by `glrt chart --temporal`: relative RMS error of what is on the screen, against "
        f"references of each view, over {FRAMES} frames of one sample a pixel. {size}"
    )
    yield ""
    columns = ["scene", "what moves", "mode", "rays a pixel and frame", "mean error"]
    columns.append("times lower than reset")
    if is_timed := _is_timed(tracks):
        columns.append("milliseconds a frame")
    yield f"| {' | '.join(columns)} |"
    yield "|---" * len(columns) + "|"
    for track in tracks:
        base = next(
            (
                other.mean_error
                for other in tracks
                if other[:2] == track[:2] and other.mode == "reset"
            ),
            None,
        )
        gain = f"{base / track.mean_error:.2f}" if base else "-"
        yield (
            f"| {track.scene} | {_WORDS[track.sequence]} | {track.mode} | {_rays(track):.1f} "
            f"| {track.mean_error:.3f} | {gain if track.mode != 'reset' else '1'} |"
            + (f" {_time(track)} |" if is_timed else "")
        )
    if is_timed:
        yield ""
        yield (
            "Milliseconds are medians with quartiles. The modes take turns after each frame; times "
            "end when the picture is on the driver."
        )
    for name in dict.fromkeys(track.scene for track in tracks):
        yield ""
        yield f"![Error against frames in {name}]({name}.temporal.svg)"


def _sequences(tracks: Sequence[Track]) -> list[str]:
    return [*dict.fromkeys(track.sequence for track in tracks)]


def _charts(tracks: Sequence[Track]) -> list[Chart]:
    """Error against frames for each sequence; then against milliseconds, where they are timed."""
    names = _sequences(tracks)
    timed = [_clock_chart(name, tracks) for name in names] if _is_timed(tracks) else []
    return [*(_chart(name, tracks) for name in names), *timed]


def _clock_chart(sequence: str, tracks: Sequence[Track]) -> Chart:
    curves = [
        Curve(track.mode, [track.milliseconds.value], [track.mean_error])
        for track in tracks
        if track.sequence == sequence and track.milliseconds
    ]
    x_label, y_label = "milliseconds a frame, median", "mean relative RMS error on the screen"
    return Chart(f"{sequence}: error by time", x_label, y_label, curves)


def _chart(sequence: str, tracks: Sequence[Track]) -> Chart:
    curves = [
        Curve(track.mode, [one.frame for one in track.seen], [one.error for one in track.seen])
        for track in tracks
        if track.sequence == sequence
    ]
    since = "frames" if sequence == "orbit" else "frames since the light changed"
    return Chart(_WORDS[sequence], since, "relative RMS error on the screen", curves)
