"""A list of what the scene holds: camera, light, objects and media.

Modules, each importing only what stands above it:

- contents: rows of the list
- row: one row with its eye and its lock
- listing: the list in the panel, with the mouse and keys
"""
