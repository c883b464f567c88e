"""Widgets that several panels use.

Modules, each importing only what stands above it:

- tips: tooltips
- boxes: boxes over the window
- slider_text: text of a slider
- steady_widget: keeps the last used widget in place
- cost_badges: marks that show the cost of an edit
- rows: rows with a label and a widget
- scrub: a drag on a label
- reset: a double click on a value
- finder: rows of the panel by name
- explanations: meaning of each control, with its equation
- fields: one widget for each kind of field
"""
