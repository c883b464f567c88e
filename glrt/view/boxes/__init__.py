"""Boxes over the picture, which stay open while the scene is edited.

Modules, each importing only what stands above it:

- export_box: what is to be exported, and how far that is
"""
