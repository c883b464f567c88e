"""Popups with the questions of the window, such as before edits are lost."""

from imgui_bundle import ImVec2, hello_imgui, imgui

from glrt.view.app import App
from glrt.view.messages import nothing


def draw_question(app: App) -> None:
    """Draw the present question in a popup; Escape and "cancel" close it without an action."""
    question = app.messages.question
    if question is None:
        return
    title = f"{question.title}##question"
    if not imgui.is_popup_open(title):
        if app.asked is question:  # Escape closed it
            app.messages.question = app.asked = None
            return
        imgui.open_popup(title)
        app.asked = question
    center = imgui.get_main_viewport().get_center()
    imgui.set_next_window_pos(center, imgui.Cond_.appearing.value, ImVec2(0.5, 0.5))
    flags = imgui.WindowFlags_.always_auto_resize.value
    if not imgui.begin_popup_modal(title, None, flags)[0]:
        return
    imgui.push_text_wrap_pos(hello_imgui.em_size(26))
    imgui.text_unformatted(question.text)
    imgui.pop_text_wrap_pos()
    imgui.spacing()
    for name, act in {**question.answers, "cancel": nothing}.items():
        if imgui.button(name):
            imgui.close_current_popup()
            app.messages.question = app.asked = None
            act()
        imgui.same_line()
    imgui.new_line()
    imgui.end_popup()
