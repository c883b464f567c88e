"""The start screen: what was opened last, and the scenes that come with glrt as pictures."""

from collections.abc import Callable
from pathlib import Path

from imgui_bundle import ImVec2, hello_imgui, imgui

from glrt.core.text import escaped
from glrt.view.app import App
from glrt.view.edits.edited_state import State
from glrt.view.start.thumbnails import TILE, Thumbnails
from glrt.view.widgets.tips import explain

NAME = "scenes"  # of the part that scrolls
_LIST = 16.0  # em: width of the list of files left of the pictures
_TILE = 11.0  # em: least width of a picture
_BESIDE = 46.0  # em: from this width on, files stand left of the pictures, else above them
_FEW = 3  # files above the pictures
_PROBLEM = (1.0, 0.55, 0.35, 1.0)
_DROP = "or drop a scene, a model or a picture on the window"


class StartScreen:
    """Scenes and files to open, in place of the picture until one is chosen."""

    def __init__(self, read: Callable[[], Thumbnails]) -> None:
        """Read no pictures before the screen is drawn: that takes 0.1 s. It releases them."""
        self._read, self._pictures = read, list[Thumbnails]()
        self._behind: State | None = None  # since it was opened
        self._frame = -2  # that showed it last

    def draw(self, app: App) -> None:
        """Draw the screen in the present window; a scene that comes otherwise ends it."""
        before, self._frame = self._frame, imgui.get_frame_count()
        if self._frame > before + 1:
            self._behind = app.session.state
        if self._behind is not app.session.state:
            app.shows_start = False
            return None
        if app.session.problem:
            imgui.push_style_color(imgui.Col_.text, _PROBLEM)
            imgui.text_wrapped(app.session.problem)
            imgui.pop_style_color()
        if app.files.aside.opening:
            return _stage(app.files.aside.text, app.files.aside.opening.share)
        width, em = imgui.get_content_region_avail().x, hello_imgui.em_size()
        is_wide = width > _BESIDE * em and bool(app.files.recent)
        imgui.begin_child("files", ImVec2(_LIST * em, 0) if is_wide else ImVec2(0, _height(app)))
        _files(app, len(app.files.recent) if is_wide else _FEW)
        imgui.end_child()
        if is_wide:
            imgui.same_line()
        imgui.begin_child(NAME)
        self._scenes(app)
        imgui.end_child()
        return None

    def _scenes(self, app: App) -> None:
        """Draw the pictures of the scenes in rows, each with its name."""
        style, room = imgui.get_style(), imgui.get_content_region_avail().x
        count = max(1, int(room / hello_imgui.em_size(_TILE)))
        width = (room - (count - 1) * style.item_spacing.x) / count
        for number, (name, part) in enumerate(self._thumbnails.parts.items()):
            if number % count:
                imgui.same_line()
            imgui.begin_group()
            if self._tile(name, width - 2 * style.frame_padding.x):
                app.files.ask_open(name)
            explain(part.title)
            imgui.text(name)
            imgui.end_group()

    def _tile(self, name: str, width: float) -> bool:
        """Draw a picture as a button, `width` pixels wide; return whether it was pressed."""
        texture, part = self._thumbnails.texture, self._thumbnails.parts[name]
        assert texture
        shown, size = imgui.ImTextureRef(texture.glo), ImVec2(width, width * TILE[1] / TILE[0])
        return imgui.image_button(name, shown, size, ImVec2(*part.low), ImVec2(*part.high))

    def release(self) -> None:
        """Release the pictures."""
        for pictures in self._pictures:
            pictures.release()
        self._pictures.clear()

    @property
    def _thumbnails(self) -> Thumbnails:
        """The pictures, which are read once."""
        self._pictures = self._pictures or [self._read()]
        return self._pictures[0]


def _stage(text: str, share: float) -> None:
    """Draw how far a scene is that a thread reads, in the middle."""
    room, width = imgui.get_content_region_avail(), hello_imgui.em_size(_LIST)
    imgui.set_cursor_pos(ImVec2((room.x - width) / 2, room.y / 2))
    imgui.begin_group()
    imgui.text(text)
    imgui.progress_bar(share, ImVec2(width, 0.0), "")
    imgui.text_disabled("Escape cancels")
    imgui.end_group()


def _height(app: App) -> float:
    """Return the height of the files above the pictures, in pixels."""
    rows = min(len(app.files.recent), _FEW)
    lines = (1 + rows + bool(rows)) * imgui.get_text_line_height_with_spacing()
    return float(imgui.get_frame_height_with_spacing() + lines + imgui.get_style().item_spacing.y)


def _files(app: App, most: int) -> None:
    """Draw the button that opens a file, and the files that were opened last."""
    if imgui.button("open a file"):
        app.files.browse_open()
    imgui.text_wrapped(_DROP)
    if not app.files.recent:
        return
    imgui.text_disabled("opened lately")
    for number, source in enumerate(app.files.recent[:most]):
        path = Path(source)
        if imgui.selectable(f"{escaped(path.name)}##{number}", False)[0]:
            app.files.ask_open(source)
        explain(f"{path.name} in {path.parent}" if path.is_absolute() else "comes with glrt")
