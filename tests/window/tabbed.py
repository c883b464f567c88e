"""The test engine's hand on a panel in tabs: it turns to the tab of what it is sent to."""

from collections.abc import Callable
from typing import Any, get_args

from imgui_bundle import imgui

from glrt.view.state.preferences import Tab

PANEL = "//Controls/"
_SENT = (  # methods whose first argument is an item
    *("item_click", "item_open", "item_close", "item_input_value", "item_double_click"),
    *("item_info", "combo_click", "mouse_move", "scroll_to_item_y"),
)
_QUIETLY = int(imgui.test_engine.TestOpFlags_.no_error)


def _list_of(choice: str) -> str:
    """The list that a choice belongs to, as in `method/nee`."""
    start = PANEL if choice.startswith(PANEL) else ""
    return start + choice.removeprefix(start).partition("/")[0]


class TabbedContext:
    """A context of the engine; `turn` shows a tab, and `shown` names the one that is shown."""

    def __init__(self, ctx: Any, turn: Callable[[Tab], None], shown: Callable[[], Tab]) -> None:
        self._ctx, self._turn, self._shown = ctx, turn, shown
        self._reference = ""

    def __getattr__(self, name: str) -> Any:
        method = getattr(self._ctx, name)
        if name not in _SENT:
            return method

        def sent(item: Any, *rest: Any, **named: Any) -> Any:
            if isinstance(item, str) and not rest and not named.get("flags"):
                self._look_for(_list_of(item) if name == "combo_click" else item)
            elif isinstance(item, str) and name == "item_input_value":
                self._look_for(item)
            return method(item, *rest, **named)

        return sent

    def set_ref(self, reference: str) -> None:
        self._reference = reference
        self._ctx.set_ref(reference)

    def _look_for(self, item: str) -> None:
        """Turn to the tab that has an item of the panel; stay where none has it."""
        is_relative = not item.startswith("//") and self._reference == PANEL.strip("/")
        if not (is_relative or item.startswith(PANEL)):
            return
        before = self._shown()
        for tab in (before, *(tab for tab in get_args(Tab) if tab != before)):
            if tab != self._shown():
                self._turn(tab)
            if self._ctx.item_info(item, _QUIETLY).id_:
                return
        self._turn(before)
