"""Inspection of pixels in the panel and in the picture: zoom, values, histogram."""

import math

import numpy as np
from imgui_bundle import ImVec2, hello_imgui, imgui, implot

from glrt.core.text import counted
from glrt.image.tonemap import expose_and_encode
from glrt.rendering.layer_weights import Reading
from glrt.rendering.pass_film import Array
from glrt.settings import Cost
from glrt.view.app import App
from glrt.view.controls import switch
from glrt.view.state.costs import limit_beyond
from glrt.view.state.histogram import Histogram
from glrt.view.state.zoom import FIT
from glrt.view.viewport.views import limit_text
from glrt.view.widgets.fields import beside, button, edited, tip

SCALES = {"1:1": 1.0, "4:1": 4.0, "16:1": 16.0}
PIXEL = switch(
    "pixel_values",
    "show what the pixel under the mouse holds: radiance, its standard error, samples, and its "
    "colour on the screen",
    Cost.FREE,
)
_ZERO = np.zeros(1)
HEIGHT = 7  # of the histogram, in em


def draw_inspector(app: App) -> None:
    """Draw the zoom, the switch for pixel values, and the histogram."""
    if button("fit", app.zoom != FIT):
        app.zoom_to(None)
    tip("The whole picture, as large as fits; Ctrl and the wheel zoom, Ctrl and a drag move it")
    for name, scale in SCALES.items():
        beside(name)
        if button(name, app.zoom.scale != scale):
            app.zoom_to(scale)
        tip(f"{scale:g} x {scale:g} pixels of the screen for one of the picture")
    wanted = edited(PIXEL, app.inspects)
    app.inspects = app.inspects if wanted is None else wanted
    if last := app.progress.last:
        _histogram(last.histogram, app.session.settings.exposure)
    else:
        imgui.text_disabled("histogram: from two observations on")
        imgui.dummy(ImVec2(0, hello_imgui.em_size(HEIGHT)))  # keep the rows below in place


def _histogram(shown: Histogram, exposure: float) -> None:
    """Draw the shares of pixels by their distance from white, in EV."""
    stops = shown.stops + exposure
    size = ImVec2(-1, hello_imgui.em_size(HEIGHT))
    flags = implot.Flags_.no_menus | implot.Flags_.no_legend | implot.Flags_.no_mouse_text
    if implot.begin_plot("##histogram", size, int(flags)):  # False where it is scrolled out
        no_ticks = implot.AxisFlags_.no_tick_labels.value
        implot.setup_axes("EV from white", "pixels", 0, no_ticks)
        high = float(shown.shares.max()) or 1.0
        implot.setup_axes_limits(-10, 6, 0, 1.1 * high, implot.Cond_.always.value)
        implot.plot_bars("pixels", stops, shown.shares, float(stops[1] - stops[0]))
        implot.plot_inf_lines("white", _ZERO)
        implot.end_plot()
    imgui.text_disabled(
        f"{100 * shown.above(exposure):.2g} % brighter than white, {100 * shown.black:.2g} % black"
    )


def pixel_under(app: App, x: float, y: float) -> tuple[int, int] | None:
    """Return the pixel (column, row) at a place of the picture, (0, 0) to (1, 1); None outside."""
    renderer = app.session.renderer
    if not renderer or not app.session.samples or not (0 <= x < 1 and 0 <= y < 1):
        return None
    width, height = renderer.size
    return int(x * width), int(y * height)


def pixel_text(app: App, x: float, y: float) -> list[str]:
    """Return lines with the values of the pixel at a place of the picture; none outside of it."""
    pixel, renderer = pixel_under(app, x, y), app.session.renderer
    if not pixel or not renderer:
        return []
    found = renderer.reading(app.session.weights, *pixel)
    picked = app.pick(x, y)
    thing = app.session.scene.objects[picked.number] if picked else None
    name = f", {thing.name or thing.shape}" if thing else ""
    settings = app.session.settings
    codes = expose_and_encode(found.radiance, settings.exposure, settings.tonemap)
    shown = " ".join(f"{int(code):3d}" for code in codes)
    return [
        f"pixel {pixel[0]}, {pixel[1]}{name}: {counted(found.samples, 'sample')}",
        f"radiance {_numbers(found.radiance)}",
        f"standard error {_error(found)}",
        f"on the screen {shown}",
        *_bounces_text(app, pixel),
    ]


def _bounces_text(app: App, pixel: tuple[int, int]) -> list[str]:
    """Return a line with the mean bounces of a pixel's paths, if that view is shown."""
    renderer = app.session.renderer
    is_shown = renderer and app.show.drawn == "bounces"
    found = renderer.aov_pixel("bounces", *pixel) if renderer and is_shown else None
    if found is None:
        return []
    mean, error = (float(values[0]) for values in found)
    band = f" +- {error:.2g}" if error >= 0 else ""
    return [f"bounces until the end {mean:.4g}{band}{limit_text(limit_beyond(app.session))}"]


def _numbers(values: Array) -> str:
    return "  ".join(f"{value:.4g}" for value in values)


def _error(found: Reading) -> str:
    is_known = all(math.isfinite(float(value)) for value in found.stderr)
    return _numbers(found.stderr) if is_known else "known from two observations on"
