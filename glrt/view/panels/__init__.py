"""Panels of the window.

Modules, each importing only what stands above it:

- layout: sizes of the panels, and their ground
- confirmations: questions before data is lost
- tour: five steps for a newcomer
- legend: legend of false colours
- plots: numbers, and the error over time
- gizmo: handles of the selected object
- axes: axes of the scene in a corner of the picture
- key_table: keys, and how to change them; all of them over the window
- navigation: keys that lead from the picture to the panel
- compare: displayed view, and the reference picture
- lights: light groups and their lamps
- materials: material of the selected object
- media: medium in the selected object
- inspector: pixels and the histogram
- objects: selected object, and new ones
- files: open and save
- background: light from infinity
- sun: position of the sun
- path_overlay: paths over the picture, and from outside
- pixel_paths: paths of a pixel
- pair_images: pictures A and B
- shortcuts: keyboard commands
- viewport: the picture and the mouse
"""
