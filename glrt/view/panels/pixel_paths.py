"""Section of the panel that shows the paths of a pixel, and why it is bright."""

from imgui_bundle import hello_imgui, imgui

from glrt.analysis.path_report import explanation, light_rows, percent, triple, vertex_rows
from glrt.core.text import counted
from glrt.rendering.paths.values import Path, PixelPaths
from glrt.settings import Cost
from glrt.view.app import App
from glrt.view.controls import Control, switch
from glrt.view.panels.path_overlay import COLORS
from glrt.view.viewport.path_lines import Kind
from glrt.view.widgets.fields import beside, button, edited, tip
from glrt.view.widgets.steady_widget import ANCHOR

CHOOSING = switch(
    "choose_a_pixel",
    "a click in the picture traces the samples of that pixel again, and shows their paths",
    Cost.FREE,
)
PARTICLES = switch(
    "particles",
    "of the next pixel that is clicked, also list the particles from lamps that reach it, as a "
    "render with --caustics on has them; the picture in the window has none",
    Cost.FREE,
)
SAMPLE = Control("sample", "integer", "which sample is shown, from 0", Cost.FREE, low=0)
_LEGEND: dict[Kind, str] = {
    "path": "the path",
    "escape": "leaves the scene",
    "sampled": "to a point on a lamp",
    "hidden": "to one that is hidden",
    "linked": "a particle, linked to the camera",
}


def draw_pixel_paths(app: App) -> None:
    """Draw the choice of a pixel, its samples by the light they carry, and one path in full."""
    paths = app.paths
    if paths.is_new:
        ANCHOR.go_here()
        paths.is_new = False
    wanted = edited(CHOOSING, paths.is_choosing)
    paths.is_choosing = paths.is_choosing if wanted is None else wanted
    wanted = edited(PARTICLES, paths.with_particles)
    paths.with_particles = paths.with_particles if wanted is None else wanted
    if paths.busy:
        imgui.text_disabled(paths.busy)
    found, path = paths.found, paths.shown
    if not found or not path:
        imgui.text_disabled("no pixel is chosen")
        return
    _pixel(app, found)
    _samples(app, found)
    _particles(app, found)
    sample = edited(SAMPLE, path.sample)
    if sample is not None:
        paths.show(min(sample, len(found.radiances) - 1))
    _path(path)


def _pixel(app: App, found: PixelPaths) -> None:
    x, y = found.pixel
    imgui.text(f"pixel {x}, {y}: {counted(len(found.radiances), 'sample')}")
    imgui.text(f"mean {triple(found.mean)}")
    if found.recipe.settings.caustics == "on":
        _dimmed("by paths from the camera, without particles")
    if not app.paths.is_of(app.session.scene):
        imgui.text_wrapped("The scene has changed since; click the pixel again.")
    if button("save as a test"):
        app.files.save_paths(found)
    tip("A JSON file with these paths: glrt paths --replay FILE reports whether they are the same")
    beside("forget")
    if button("forget##paths"):
        app.paths.forget()


def _samples(app: App, found: PixelPaths) -> None:
    """Draw the list of samples that carry most light; a click shows one."""
    _dimmed("samples by their share of its light")
    for path in found.paths:
        share = percent(found.shares[path.sample])
        is_shown = app.paths.shown is path
        if imgui.selectable(f"sample {path.sample}: {share}##{path.sample}", is_shown)[0]:
            app.paths.show(path.sample)


def _particles(app: App, found: PixelPaths) -> None:
    """Draw the particles that reach the pixel and the light that they add; a click shows one."""
    there = found.particles
    if not there:
        return
    imgui.separator_text("particles")
    imgui.text_wrapped(
        f"{counted(len(there.numbers), 'particle')} of {counted(there.samples, 'sample')} reached "
        f"this pixel, and bring {triple(there.mean)}; "
        f"with the paths {triple(found.mean + there.mean)}"
    )
    _dimmed("by their share of what particles bring")
    whole = float(there.radiances.sum(dtype="float64")) or 1.0
    for path in there.paths:
        share = percent(sum(path.radiance) / whole)
        name = f"sample {path.sample}, particle {path.particle}"
        if imgui.selectable(f"{name}: {share}###{name}", app.paths.shown is path)[0]:
            app.paths.shown = path


def _path(path: Path) -> None:
    which = "" if path.particle is None else f", particle {path.particle}"
    imgui.separator_text(f"sample {path.sample}{which}")
    imgui.text_wrapped(f"radiance {triple(path.radiance)}, ended by: {path.end}")
    if told := explanation(path):
        imgui.text_wrapped(told)
    _entries(vertex_rows(path), (0, 1, 2), (5, 6))
    if path.contributions:
        imgui.text("light that it found")
        _entries(light_rows(path), (0, 1, 2), (7, 6, 4, 3))
    for kind, meaning in _LEGEND.items():
        imgui.text_colored(COLORS[kind], "---")
        imgui.same_line(hello_imgui.em_size(2.5))
        _dimmed(meaning)


def _dimmed(text: str) -> None:
    """Draw grey text, wrapped where the panel is narrow."""
    imgui.push_text_wrap_pos(0.0)
    imgui.text_disabled(text)
    imgui.pop_text_wrap_pos()


def _entries(rows: list[tuple[str, ...]], titles: tuple[int, ...], rest: tuple[int, ...]) -> None:
    """Draw rows of a table below its headings as lines of text, which fit a narrow panel.

    Each begins with the columns `titles`; those of `rest` follow in grey, with their headings.
    """
    headings = rows[0]
    for row in rows[1:]:
        imgui.text_wrapped("  ".join(row[column] for column in titles))
        imgui.indent()
        if told := ", ".join(f"{headings[column]} {row[column]}" for column in rest if row[column]):
            _dimmed(told)
        imgui.unindent()
