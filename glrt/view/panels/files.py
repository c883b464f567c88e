"""The part of the panel that opens and saves: scenes, pictures and their recipes."""

from imgui_bundle import hello_imgui, imgui

from glrt.files import printable
from glrt.scene.catalog import scene_names
from glrt.view import file_dialogs
from glrt.view.app import App
from glrt.view.panels.widgets import button, tip


def draw_files(app: App) -> None:
    """Scenes to open, and where pictures and scenes go."""
    _chooser(app)
    app.open_path, entered = _path("open", app.open_path, "scene file or picture")
    tip("A scene file, or a picture rendered by glrt: opens its scene, camera and settings")
    imgui.same_line()
    if button("open", bool(app.open_path)) or (entered and app.open_path):
        app.open(app.open_path)
    if _browse("open"):
        app.dialogs.ask_open("Open a scene, a model or a picture", file_dialogs.SCENES, app.open)
    has_picture = app.session.samples > 0
    app.save_path, entered = _path("save", app.save_path, "picture.png, or .exr, .npy")
    imgui.same_line()
    if button("save", has_picture) or (entered and has_picture):
        app.save()
    tip("The picture as shown, with its recipe; .exr holds radiance and its standard error")
    if has_picture and _browse("save"):
        app.dialogs.ask_save("Save the picture", app.save_path, file_dialogs.PICTURE, app.save)
    app.scene_path, entered = _path("scene file", app.scene_path, "scene.toml")
    imgui.same_line()
    if button("save scene", bool(app.scene_path)) or (entered and app.scene_path):
        app.save_scene()
    tip(
        "The scene as a TOML file. Comments, order and formatting of the file that it was opened "
        "from are kept."
    )
    if _browse("scene file"):
        app.dialogs.ask_save("Save the scene", app.scene_path, file_dialogs.SCENE, app.save_scene)
    _recipe(app, has_picture)


def _chooser(app: App) -> None:
    names = scene_names()
    index = names.index(app.source) if app.source in names else -1
    imgui.set_next_item_width(hello_imgui.em_size(12))
    chosen, index = imgui.combo("scene", index, names)
    if chosen:
        app.open(names[index])


def _recipe(app: App, has_picture: bool) -> None:
    if button("copy recipe", has_picture):
        app.copy_recipe()
    tip(
        "Copies scene, settings and samples of this picture as text, for another window or a report"
    )
    imgui.same_line()
    if button("paste recipe"):
        app.paste_recipe()


def _path(name: str, path: str, hint: str) -> tuple[str, bool]:
    """A box for a path: its text, and whether Enter ended it."""
    imgui.set_next_item_width(min(hello_imgui.em_size(12), 0.5 * imgui.get_window_width()))
    shown = printable(path)
    _, typed = imgui.input_text_with_hint(f"##{name}", hint, shown)
    is_entered = imgui.is_item_deactivated() and imgui.is_key_pressed(imgui.Key.enter)
    return path if typed == shown else typed, is_entered


def _browse(name: str) -> bool:
    """Whether the dialog of a row is asked for; there is no such button without dialogs."""
    if not file_dialogs.are_there():
        return False
    imgui.same_line()
    return imgui.button(f"...##{name}")
