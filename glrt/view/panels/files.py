"""Section of the panel that opens and saves scenes, pictures and their recipes."""

from pathlib import Path

from imgui_bundle import hello_imgui, imgui

from glrt.core.text import escaped
from glrt.scene.scenefile.catalog import scene_names
from glrt.view.app import App
from glrt.view.files import Files
from glrt.view.widgets.fields import beside, button, tip
from glrt.view.widgets.rows import WORDS, Row


def draw_files(app: App) -> None:
    """Draw the widgets to open scenes, and to save pictures and scenes."""
    files = app.files
    _chooser(files)
    Row("recent", WORDS).draw(lambda: _recent(files))
    files.open_path, entered = _path("open", files.open_path, "scene, model or picture")
    tip("A scene file, a model, or a picture rendered by glrt: that opens its scene and settings")
    beside("open")
    if button("open", bool(files.open_path)) or (entered and files.open_path):
        files.ask_open(files.open_path)
    if _browse("open"):
        files.browse_open()
    has_picture = app.session.samples > 0
    files.picture_path, entered = _path("save", files.picture_path, "picture.png, or .exr, .npy")
    beside("save picture")
    if button("save picture", has_picture) or (entered and has_picture):
        files.ask_save_picture(files.picture_path)
    tip("The picture as shown, with its recipe; .exr holds radiance and its standard error")
    if has_picture and _browse("save"):
        files.browse_picture()
    files.scene_path, entered = _path("scene file", files.scene_path, "scene.toml")
    beside("save scene")
    if button("save scene", bool(files.scene_path)) or (entered and files.scene_path):
        files.ask_save_scene(files.scene_path)
    tip(
        "The scene as a TOML file. Comments, order and formatting of the file that it was opened "
        "from are kept."
    )
    if _browse("scene file"):
        files.browse_scene()
    _recipe(files, has_picture)


def _chooser(files: Files) -> None:
    names = scene_names()
    index = names.index(files.source) if files.source in names else -1
    Row("scene", WORDS).draw(lambda: _scenes(files, names, index))


def _scenes(files: Files, names: list[str], index: int) -> None:
    if not imgui.begin_combo("scene", names[index] if index >= 0 else "one of glrt's"):
        return
    for number, name in enumerate(names):
        if imgui.selectable(name, number == index)[0]:
            files.ask_open(name)
    imgui.end_combo()


def _recent(files: Files) -> None:
    """Draw the list of recent files, with their folders, since names may be equal."""
    if not imgui.begin_combo("recent", "opened lately"):
        return
    for number, source in enumerate(files.recent):
        path = Path(source)
        shown = f"{path.name} in {path.parent}" if path.is_absolute() else source
        if imgui.selectable(f"{escaped(shown)}##{number}", False)[0]:
            files.ask_open(source)
    imgui.end_combo()


def _recipe(files: Files, has_picture: bool) -> None:
    if button("copy recipe", has_picture):
        files.copy_recipe()
    tip(
        "Copies scene, settings and samples of this picture as text, for another window or a report"
    )
    beside("paste recipe")
    if button("paste recipe"):
        files.ask_paste()


def _path(name: str, path: str, hint: str) -> tuple[str, bool]:
    """Draw a box for a path; return its text, and whether Enter ended the input."""
    imgui.set_next_item_width(min(hello_imgui.em_size(12), 0.5 * imgui.get_window_width()))
    shown = escaped(path)
    _, typed = imgui.input_text_with_hint(f"##{name}", hint, shown)
    is_entered = imgui.is_item_deactivated() and imgui.is_key_pressed(imgui.Key.enter)
    return path if typed == shown else typed, is_entered


def _browse(name: str) -> bool:
    """Draw the button of a row that opens a file dialog; return whether it was pressed."""
    beside("...")
    return button(f"...##{name}")
