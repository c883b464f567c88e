"""Colours and sizes of the window: its theme, and its scale."""

from imgui_bundle import ImVec2, ImVec4, hello_imgui, imgui

THEMES = {
    "dark": hello_imgui.ImGuiTheme_.darcula_darker,
    "light": hello_imgui.ImGuiTheme_.light_rounded,
}
_HIDE = (  # lists, and titles of boxes: they hide what lies below
    imgui.Col_.popup_bg,
    imgui.Col_.title_bg,
    imgui.Col_.title_bg_active,
    imgui.Col_.title_bg_collapsed,
)
_SPACING = "item_spacing", "item_inner_spacing", "frame_padding"  # alike in all themes
TOOLTIP_AFTER = 0.5  # seconds that the mouse rests on a row


class WindowStyle:
    """The style of Dear ImGui, as the user has chosen it."""

    def __init__(self) -> None:
        """Nothing is chosen yet."""
        self._chosen: tuple[str, float] | None = None
        self._sizes: dict[str, float | ImVec2] = {}  # before any theme

    def choose(self, theme: str, scale: float) -> None:
        """Apply a theme; the scale enlarges type, margins and widgets together."""
        if (theme, scale) == self._chosen:
            return
        self._chosen = theme, scale
        style = imgui.get_style()
        self._sizes = self._sizes or _sizes_of(style)
        for name, size in self._sizes.items():
            setattr(style, name, size)
        hello_imgui.apply_theme(THEMES["dark"])
        spacing = {name: _copied(getattr(style, name)) for name in _SPACING}
        hello_imgui.apply_theme(THEMES[theme])
        for name, space in spacing.items():
            setattr(style, name, space)
        for part in _HIDE:
            style.set_color_(part, opaque(style.color_(part)))
        style.hover_delay_short = TOOLTIP_AFTER
        style.frame_border_size = 1.0  # edges for light boxes on a light ground
        params = hello_imgui.get_runner_params().imgui_window_params
        params.background_color = opaque(style.color_(imgui.Col_.window_bg))
        style.scale_all_sizes(scale)
        style.font_scale_main = scale


def _sizes_of(style: imgui.Style) -> dict[str, float | ImVec2]:
    """Return a copy of all lengths of the style, and of its other numbers, by name."""
    values = {name: getattr(style, name) for name in dir(style) if not name.startswith("_")}
    lengths = {name: _copied(v) for name, v in values.items() if isinstance(v, ImVec2)}
    numbers = {name: value for name, value in values.items() if isinstance(value, float)}
    return {**lengths, **numbers}


def _copied(length: ImVec2) -> ImVec2:
    return ImVec2(length.x, length.y)


def opaque(color: ImVec4) -> ImVec4:
    """Return a colour without transparency."""
    return ImVec4(color.x, color.y, color.z, 1.0)
