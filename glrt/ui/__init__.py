"""The window: `window` opens it, `panel` and `viewport` fill it, `session` is what they edit.

`controls`, `orbit`, `history` and `session` know no window; the others draw with Dear ImGui.
"""
