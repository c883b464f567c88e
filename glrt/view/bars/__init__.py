"""Bars above and below the picture.

Modules, each importing only what stands above it:

- camera_menu: views of the camera
- toolbar: files, the view, and what is changed most often
- status: messages and figures
- timeline: frames and keys of an animation
- framed: the picture between its bars
"""
