"""Figures of a render: samples, speed, error, and a forecast of the error."""

import math

import numpy as np
from imgui_bundle import ImVec2, ImVec4, hello_imgui, imgui, implot

from glrt.core.memo import kept_for_the_same
from glrt.plan.explanation import explain
from glrt.plan.methods import BIASED
from glrt.plan.plan import Plan
from glrt.process.load import MISSING, LoadMeter
from glrt.view.app import App
from glrt.view.compared_picture import Slot
from glrt.view.figure_texts import (
    error_text,
    forecast,
    percent_text,
    samples_text,
    unknown_text,
)
from glrt.view.state.error_history import Look, Progress
from glrt.view.widgets.fields import tip

_MOST_TICKS = 5  # of an axis: more labels would overlap
_SHADE = 0.25  # opacity of a band
_DOT = 2.5  # pixels: radius of a look in the plot
_BLUE, _ORANGE = ImVec4(0.30, 0.58, 0.90, 1.0), ImVec4(0.85, 0.58, 0.13, 1.0)
_GRAY, _GREEN = ImVec4(0.6, 0.6, 0.6, 1.0), ImVec4(0.30, 0.66, 0.36, 1.0)
_BESIDE = 36  # em: in a narrower part of the window, the plot is below the text


def draw_figures(app: App) -> None:
    """Draw the content of the part of the window below the picture."""
    columns = 2 if imgui.get_content_region_avail().x > hello_imgui.em_size(_BESIDE) else 1
    if imgui.begin_table("figures", columns, imgui.TableFlags_.sizing_stretch_same.value):
        imgui.table_next_column()
        for line in figures(app):
            imgui.text_wrapped(line)
        _kernel(app)
        imgui.table_next_column()
        _plot(app)
        imgui.end_table()


def figures(app: App) -> list[str]:
    """Return the figures of the picture as lines of text."""
    session, progress = app.session, app.progress
    width, height = session.renderer.size if session.renderer else (0, 0)
    work = session.renderer.work if session.renderer else 0.0
    rate = work * width * height / max(session.rendering, 1e-9)
    preview = " (coarse while it moves)" if session.is_preview else ""
    lines = [
        samples_text(session.samples, session.settings.samples) + preview,
        f"{rate / 1e6:.2f} million samples/s, {1e3 * app.frame_seconds:.0f} ms a frame",
        f"error {error_text(progress.last) if progress.last else unknown_text(session)}",
        forecast(progress, app.preferences.target_error, session.settings.samples),
        load_text(app.load),
    ]
    if session.settings.method in BIASED:
        lines.insert(3, f"of noise alone: {session.settings.method} leaves out or blurs some light")
    if app.pair.slot:
        lines.append(_slot_text(app.pair.slot))
    if progress.last and progress.last.nonfinite:
        lines.append(f"{progress.last.nonfinite:,} samples were not finite and were dropped")
    return lines


def short_figures(app: App) -> str:
    """Return samples, error and frames a second, in one line."""
    session, last, load = app.session, app.progress.last, app.load.last
    parts = [
        samples_text(session.samples, session.settings.samples),
        f"{percent_text(last.error)}" if last else "",
        f"{load.rate:.3g} frames/s" if load else "",
    ]
    return "  ".join(filter(None, parts))


def load_text(meter: LoadMeter) -> str:
    """Return frames a second, and what they take of the processors and of the GPU."""
    load, gpu = meter.last, meter.gpu
    if load is None:
        return "load not known yet"
    plural = "s" if meter.processors > 1 else ""
    share = f"{100 * load.cpu:.0f} % of {meter.processors} processor{plural}"
    text = f"{load.rate:.3g} frames/s, {share}"
    if load.gpu is not None:
        return f"{text}, {100 * load.gpu:.0f} % of the GPU"
    return f"{text}; GPU: {gpu.unknown}" if gpu.unknown == MISSING else text


def _slot_text(slot: Slot) -> str:
    """Return a line with the samples, seconds and error of A, or what A waits for."""
    session, last = slot.session, slot.progress.last
    error = f"error {error_text(last)}" if last else "error unknown"
    return session.busy or f"A: {session.samples} samples in {session.rendering:.1f} s, {error}"


def _kernel(app: App) -> None:
    """Draw the features of the kernel, and the driver that runs it."""
    session = app.session
    if not session.renderer:
        return
    inside, left_out = _contents(session.renderer.plan)
    imgui.push_text_wrap_pos(0.0)
    imgui.text_disabled(f"{session.pipeline} kernel: {inside}")
    tip(f"left out\n{left_out}")
    baked = "; the kernel of a scene at rest" if session.renderer.is_baked else ""
    imgui.text_disabled(f"{session.renderer.context.renderer}{baked}")
    imgui.pop_text_wrap_pos()


@kept_for_the_same
def _contents(plan: Plan) -> tuple[str, str]:
    """Return the features that a kernel contains; and those it leaves out, with the reasons."""
    features = explain(plan)
    inside = ", ".join(feature.name for feature in features if feature.present)
    layers = f"; {plan.layers} layers" if plan.layers else ""
    left_out = "; ".join(f"{f.name}: {f.reason}" for f in features if not f.present)
    return f"{inside}{layers}", left_out


def _plot(app: App) -> None:
    """Plot the error over seconds, both logarithmic: the looks, and the way to the target."""
    apart = hello_imgui.em_size(0.4)
    room = ImVec2(3.5 * apart, 1.5 * apart)  # for half a label at the ends of the axes
    implot.push_style_var(implot.StyleVar_.plot_padding.value, room)
    implot.push_style_var(implot.StyleVar_.label_padding.value, ImVec2(apart, apart))
    _draw_plot(app)
    implot.pop_style_var(2)


def _draw_plot(app: App) -> None:
    looks = app.progress.drawn
    size = ImVec2(-1, max(imgui.get_content_region_avail().y, hello_imgui.em_size(6)))
    if not implot.begin_plot("##error", size, implot.Flags_.no_menus.value):
        return
    implot.setup_legend(implot.Location_.north_east.value)
    implot.setup_axes("seconds of rendering", "error")
    implot.setup_axis_scale(implot.ImAxis_.x1.value, implot.Scale_.log10.value)
    implot.setup_axis_scale(implot.ImAxis_.y1.value, implot.Scale_.log10.value)
    limits = _limits(app)
    for axis, ticks in (
        (implot.ImAxis_.x1, {tick: f"{tick:g}" for tick in _ticks(*limits[:2])}),
        (implot.ImAxis_.y1, {tick: f"{100 * tick:g} %" for tick in _ticks(*limits[2:])}),
    ):
        implot.setup_axis_ticks(axis.value, list(ticks), list(ticks.values()))
    implot.setup_axes_limits(*limits, implot.Cond_.always.value)
    if len(app.progress.relit) > 1:
        _line("before relight", app.progress.relit, _GRAY)
    if app.pair.slot and len(app.pair.slot.progress.drawn) > 1:
        _line("A", app.pair.slot.progress.drawn, _ORANGE)
    if len(looks) > 1:
        _band(looks)
        _line("B" if app.pair.slot else "error", looks, _BLUE)
        along, down = app.progress.slope()
        gray = implot.Spec(line_color=_GRAY)
        implot.plot_line("##slope", np.array(along), np.array(down), gray)
    _way(app.progress, app.preferences.target_error)
    implot.end_plot()


def _band(looks: list[Look]) -> None:
    """Shade the confidence band of the errors."""
    seconds = np.array([look.seconds for look in looks])
    _, low, high = (np.array(part) for part in zip(*(look.band for look in looks), strict=True))
    least = low[low > 0].min(initial=1)  # a logarithmic axis has no 0
    implot.plot_shaded("##band", seconds, np.maximum(low, least), high, _shade(_BLUE))


def _shade(color: ImVec4) -> implot.Spec:
    return implot.Spec(fill_color=color, fill_alpha=_SHADE)


def _way(progress: Progress, target: float) -> None:
    """Draw the target as a line, and the forecast of the way there, as wide as its doubt."""
    level = implot.Spec(line_color=_GREEN, flags=implot.InfLinesFlags_.horizontal.value)
    implot.plot_inf_lines("target", np.array([target]), level)
    seconds, errors = map(np.array, progress.way_to(target))
    if not len(seconds):
        return
    error, low, high = progress.drawn[-1].band
    lower, upper = errors * low / error, errors * high / error
    implot.plot_shaded("##forecast", seconds, lower, upper, _shade(_GRAY))
    implot.plot_line("##way", seconds, errors, implot.Spec(line_color=_GRAY))


def _limits(app: App) -> tuple[float, float, float, float]:
    """Return the limits of the plot, for the errors of B and of A if it gathers samples."""
    own = app.progress.limits(app.preferences.target_error)
    if not app.pair.slot or len(app.pair.slot.progress.drawn) < 2:
        return own
    other = app.pair.slot.progress.limits()
    if len(app.progress.drawn) < 2:
        return other
    first, last, least, most = zip(own, other, strict=True)
    return min(first), max(last), min(least), max(most)


def _line(name: str, looks: list[Look], color: ImVec4) -> None:
    seconds = np.array([look.seconds for look in looks])
    dots = implot.Spec(line_color=color, marker=implot.Marker_.circle.value, marker_size=_DOT)
    implot.plot_line(name, seconds, np.array([look.error for look in looks]), dots)


def _ticks(low: float, high: float) -> list[float]:
    """Return ticks of 1, 2, 5 and so on between limits; powers of ten if those are too many."""
    powers = range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1)
    fine, coarse = ([share * 10.0**p for p in powers for share in s] for s in ((1, 2, 5), (1,)))
    inside = [tick for tick in fine if low <= tick <= high]
    return inside if len(inside) <= _MOST_TICKS else [t for t in coarse if low <= t <= high]
