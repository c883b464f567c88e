"""The window.

Modules, each importing only what stands above it:

- opengl: the window's OpenGL context
- file_watch: files that another program changes
- memo: results kept while a scene stays the same
- file_dialogs: the desktop's file dialogs
- event_wait: no frame where it would show nothing new
- state: values and pure functions behind the window
- viewport: what is drawn of a picture, and moves of the camera
- app: what the window's parts share
- panels: what the user sees and edits
- window: the loop, and how it ends
"""
