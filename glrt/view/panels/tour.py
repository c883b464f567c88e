"""Five steps that show a newcomer what there is; closed for ever, or until the next start."""

from imgui_bundle import ImVec2, hello_imgui, imgui

from glrt.view.app import App
from glrt.view.state.controls import replaced

STEPS = (
    (
        "Look around",
        "Drag in the picture to turn about the pivot, use the wheel to come nearer, W A S D to "
        "walk. The picture is coarse while it moves. Home goes back to the first view. F6 and the "
        "arrow keys move in the panel instead, Escape goes back.",
    ),
    (
        "Change the light",
        "Drag `intensity` or a colour under Light. The word beside each control says what an edit "
        "costs: relight keeps all samples, restart begins anew, recompile compiles a kernel first.",
    ),
    (
        "Edit objects",
        "Click an object: it is outlined, its handles move it, and the panel shows its material. "
        "`add` makes a new one. Everything can be undone by Ctrl-Z.",
    ),
    (
        "Ask a pixel",
        "P, then a click, shows the paths of a pixel and why it is bright. I shows its values, "
        "Ctrl and the wheel zoom.",
    ),
    (
        "Keep what you have",
        "Ctrl-S saves the scene, Ctrl-E the picture, which carries the recipe to make it "
        "again. Below the picture stand its error, and when it will be small enough.",
    ),
)
_WIDTH = 22.0  # letters' heights


def draw_tour(app: App) -> None:
    """One step in the upper right, above the picture, which stays at hand."""
    if not app.preferences.tour or app.tour_step is None:
        return
    area = imgui.get_main_viewport()
    place = area.pos + ImVec2(area.size.x - hello_imgui.em_size(1), hello_imgui.em_size(3))
    imgui.set_next_window_pos(place, imgui.Cond_.appearing.value, ImVec2(1.0, 0.0))
    imgui.set_next_window_size(ImVec2(hello_imgui.em_size(_WIDTH), 0.0))
    flags = imgui.WindowFlags_.no_collapse | imgui.WindowFlags_.no_docking
    flags |= imgui.WindowFlags_.no_saved_settings | imgui.WindowFlags_.no_focus_on_appearing
    title, text = STEPS[app.tour_step]
    number = f"{app.tour_step + 1} of {len(STEPS)}"
    is_shown, is_open = imgui.begin(f"{title} ({number})###tour", True, int(flags))
    if is_shown:
        imgui.text_wrapped(text)
        imgui.spacing()
        _answers(app, app.tour_step)
    imgui.end()
    if not is_open:
        app.tour_step = None


def _answers(app: App, step: int) -> None:
    if step and imgui.button("back"):
        app.tour_step = step - 1
    if step:
        imgui.same_line()
    is_last = step == len(STEPS) - 1
    if not is_last and imgui.button("next"):
        app.tour_step = step + 1
    if not is_last:
        imgui.same_line()
    if imgui.button("close for ever"):
        app.prefer(replaced(app.preferences, tour=False))
