"""Live pictures in notebooks.

Nothing except `widget` needs the extra `notebook`.

Modules, each importing only what stands above it:

- sources: scenes of files, names, meshes and arrays
- shared_context: one OpenGL context for all pictures
- messages: messages between a page and a picture
- encoding: pictures as JPEG and PNG
- rows: controls of a picture as rows of a page
- live: a picture that refines and follows the mouse
- widget: the widget of notebooks
- show: `glrt.show`
"""
