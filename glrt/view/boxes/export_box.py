"""Box in which a picture or a film is exported, and its progress shown."""

from typing import TypeVar, get_args

from imgui_bundle import ImVec2, hello_imgui, imgui

from glrt.core.text import escaped
from glrt.settings import Denoise
from glrt.view.app import App
from glrt.view.export.exports import Exports, progress_text
from glrt.view.export.jobs import Job
from glrt.view.export.wishes import Kind, Motion, Until, Wish
from glrt.view.panels.navigation import PICTURE
from glrt.view.widgets.boxes import box
from glrt.view.widgets.tips import explain

Word = TypeVar("Word", bound=str)

NAME = "Export###export box"
SIZES = {  # pixels, by what a list says
    "HD, 1280 x 720": (1280, 720),
    "Full HD, 1920 x 1080": (1920, 1080),
    "4K, 3840 x 2160": (3840, 2160),
    "square, 1024 x 1024": (1024, 1024),
}
_TIMES = (1, 2, 4)  # the size of the view
_WIDTH, _LABELS, _NUMBER = 30.0, 7.0, 5.0  # em: of the box, its labels, and a number
_SHARE = 0.94  # of the window: the largest width
_RED = (0.95, 0.35, 0.35, 1.0)
_TYPES = {
    "picture": (["Picture", "*.png *.exr *.jpg *.npy"], ".png"),
    "film": (["Film", "*.webp *.gif *.mp4"], ".webp"),
}


def draw_export(app: App) -> None:
    """Draw the box, if it is open."""
    if not app.exports.is_open:
        return
    area, picture = imgui.get_main_viewport(), imgui.internal.find_window_by_name(PICTURE)
    part, width = picture or area, min(hello_imgui.em_size(_WIDTH), _SHARE * area.size.x)
    right = area.pos.x + area.size.x - width / 2  # a part may be narrower than the box
    middle = ImVec2(min(part.pos.x + part.size.x / 2, right), area.pos.y + area.size.y / 2)
    imgui.set_next_window_pos(middle, imgui.Cond_.appearing.value, ImVec2(0.5, 0.5))
    imgui.set_next_window_size(ImVec2(width, 0.0))
    with box(NAME, imgui.WindowFlags_.no_resize.value, has_title=True) as drawn:
        if drawn.is_shown:
            _content(app)
    if not drawn.is_open:
        app.exports.is_open = False


def _content(app: App) -> None:
    exports = app.exports
    wish: Wish = exports.wish
    wish.kind = _choice("what", wish.kind, get_args(Kind))
    _size(app, wish)
    _end(wish)
    wish.denoise = _choice("denoise", wish.denoise, get_args(Denoise))
    explain("auto takes the best filter that is here")
    if wish.kind == "film":
        _motion(wish)
    _file(app, wish)
    imgui.separator()
    if exports.job:
        _progress(exports, exports.job)
    else:
        _begin(exports)


def _begin(exports: Exports) -> None:
    """Draw the button that begins the export, and what is wrong or was done."""
    problem = exports.problem
    imgui.begin_disabled(bool(problem))
    if imgui.button("export"):
        exports.ask_begin()
    imgui.end_disabled()
    _close_button(exports)
    if problem:
        imgui.push_style_color(imgui.Col_.text, _RED)
        imgui.text_wrapped(escaped(problem))
        imgui.pop_style_color()
    elif exports.told:
        imgui.text_wrapped(exports.told)
    else:
        imgui.text_disabled("Another process renders it, and the window goes on.")


def _progress(exports: Exports, job: Job) -> None:
    """Draw how far the export is, and the button that gives it up."""
    imgui.text(progress_text(job))
    imgui.progress_bar(job.share, ImVec2(-1.0, 0.0), "")
    imgui.begin_disabled(job.is_cancelled)
    if imgui.button("cancel"):
        exports.cancel()
    imgui.end_disabled()
    _close_button(exports, "hide")
    explain("The export goes on, and the line below the picture says how far it is")


def _close_button(exports: Exports, name: str = "close") -> None:
    imgui.same_line()
    if imgui.button(name):
        exports.is_open = False


def _label(text: str) -> None:
    """Draw a label, and continue in the column of the widgets."""
    imgui.align_text_to_frame_padding()
    imgui.text(text)
    imgui.same_line(hello_imgui.em_size(_LABELS))


def _choice(label: str, value: Word, words: tuple[Word, ...]) -> Word:
    """Draw a row with a round button for each word; return the chosen one."""
    _label(label)
    for number, word in enumerate(words):
        if number:
            imgui.same_line()
        if imgui.radio_button(f"{word}##{label}", word == value):
            value = word
    return value


def _text(name: str, value: str, width: float) -> str:
    """Draw a box for a text, `width` em wide, or as wide as there is room with 0."""
    imgui.set_next_item_width(hello_imgui.em_size(width) if width else -1.0)
    return str(imgui.input_text(f"##{name}", value)[1])


def _size(app: App, wish: Wish) -> None:
    """Draw width and height; with `keep the shape`, one follows the other."""
    view = app.session.settings.size
    _label("size")
    before = wish.width, wish.height
    wish.width = _text("width", wish.width, _NUMBER)
    imgui.same_line()
    imgui.text("x")
    imgui.same_line()
    wish.height = _text("height", wish.height, _NUMBER)
    imgui.same_line()
    imgui.text("pixels")
    imgui.same_line()
    _sizes(wish, view)
    _, wish.keeps_shape = imgui.checkbox("keep the shape of the view", wish.keeps_shape)
    explain("Width and height follow each other")
    if wish.keeps_shape:
        keep_shape(wish, before, view)


def keep_shape(wish: Wish, before: tuple[str, str], view: tuple[int, int]) -> None:
    """Let the side follow that was not typed; `before`: texts of both sides a frame ago."""
    width, height = view
    if wish.width != before[0]:
        wish.height = _followed(wish.width, height / width, wish.height)
    elif wish.height != before[1]:
        wish.width = _followed(wish.height, width / height, wish.width)


def _followed(text: str, factor: float, otherwise: str) -> str:
    word = text.strip()
    is_number = word.isascii() and word.isdecimal() and len(word) < 10
    return str(max(1, round(int(word) * factor))) if is_number else otherwise


def _sizes(wish: Wish, view: tuple[int, int]) -> None:
    """Draw a list of common sizes."""
    if not imgui.begin_combo("##sizes", "", imgui.ComboFlags_.no_preview.value):
        explain("Common sizes")
        return
    own = {
        f"{factor} x the view, {factor * view[0]} x {factor * view[1]}": (
            factor * view[0],
            factor * view[1],
        )
        for factor in _TIMES
    }
    for name, size in {**own, **SIZES}.items():
        if imgui.selectable(name, False)[0]:
            wish.width, wish.height = map(str, size)
            wish.keeps_shape = name in own
    imgui.end_combo()


def _end(wish: Wish) -> None:
    """Draw what ends the render: a number of samples, or an error."""
    wish.until = _choice("until", wish.until, get_args(Until))
    imgui.same_line()
    if wish.until == "samples":
        wish.samples = _text("samples", wish.samples, _NUMBER)
        imgui.same_line()
        imgui.text("of each pixel")
    else:
        wish.error = _text("error", wish.error, _NUMBER)
        imgui.same_line()
        imgui.text("of the picture")
        explain("Estimated relative error of the picture, such as 2 % or 0.02")


def _motion(wish: Wish) -> None:
    """Draw what a film shows, and how fast it plays."""
    wish.motion = _choice("motion", wish.motion, get_args(Motion))
    if wish.motion == "turntable":
        imgui.same_line()
        wish.frames = _text("frames", wish.frames, _NUMBER)
        imgui.same_line()
        imgui.text("frames")
        explain("The camera turns once about the point that it looks at")
    _label("plays at")
    wish.rate = _text("rate", wish.rate, _NUMBER)
    imgui.same_line()
    imgui.text("frames a second")


def _file(app: App, wish: Wish) -> None:
    """Draw the file, and the button that chooses one in a dialog."""
    _label("file")
    attribute = wish.kind
    room = imgui.calc_text_size("...").x + 3 * imgui.get_style().frame_padding.x
    imgui.set_next_item_width(-room - imgui.get_style().item_spacing.x)
    shown = escaped(wish.path)
    _, typed = imgui.input_text("##file", shown)
    if typed != shown:
        setattr(wish, attribute, typed)
    explain(f"{escaped(wish.path)}\nThe end of its name chooses the format")
    imgui.same_line()
    if imgui.button("...##file"):
        kinds, suffix = _TYPES[wish.kind]

        def use(path: str, is_agreed: bool) -> None:
            setattr(wish, attribute, path)

        app.files.dialogs.ask_save("Export", wish.path, kinds, suffix, use)
