"""Edits of a scene and its settings, with undo.

Modules, each importing only what stands above it:

- scene_edits: objects and materials added, copied, renamed, removed
- ready_materials: common metals, glasses, plastics and paints
- keyframes: frames and keys of an animation
- media_edits: media added, chosen and changed
- grid_files: grids that become the density of a medium
- file_camera: cameras of glTF files, read again and saved
- sky_images: images that become the background
- texture_images: images that become the color of an object
- new_objects: new objects and their placement
- edited_state: the value that undo restores
- state_differences: differences of two states, in words
- unsaved: what a save would change
- locks: objects that no edit changes
- editing: current and earlier states
"""
