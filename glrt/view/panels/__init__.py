"""What the user sees and edits, drawn by Dear ImGui.

Modules, each importing only what stands above it:

- layout: the shares of the window that its parts have
- slider_text: where the number of a slider stands
- anchor: the widget that stays where it is
- tags: what an edit costs, beside its control
- widgets: a widget for each kind of control
- bar: commands that do not scroll
- questions: what the window asks
- tour: five steps for a newcomer
- legend: what false colours mean
- plots: figures and the error over time
- gizmo: handles of the selected object
- key_table: keys, and the choice of others
- navigation: from the picture to the panel, by keys
- compare: what is shown, and the kept picture
- lights: the light groups and their lamps
- materials: the material of the selected object
- inspector: pixels and the histogram
- objects: the selected object, and new ones
- files: open and save
- background: light from infinity
- sun: where the sun stands
- path_overlay: paths over the picture, and from outside
- pixel_paths: what the paths of a pixel tell
- panel: all subjects of the panel
- pair_images: A and B on the screen
- shortcuts: commands and steps, by keys
- viewport: the picture and the mouse
"""
