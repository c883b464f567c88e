"""Widgets that several panels use.

Modules, each importing only what stands above it:

- tips: tooltips
- slider_text: text of a slider
- steady_widget: keeps the last used widget in place
- cost_badges: badges that show the cost of an edit
- scrub: a drag on a label
- reset: a double click on a value
- finder: rows of the panel by name
- fields: one widget for each kind of field
"""
