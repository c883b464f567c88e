"""The window.

Modules, each importing only what stands above it:

- opengl: the window's OpenGL context
- file_watch: files that another program changes
- event_wait: no frame where it would show nothing new
- native: title, and files dropped on the window
- state: values and pure functions behind the window
- file_browser: a file dialog inside the window
- file_dialogs: file dialogs of the desktop, or of the window
- viewport: what is drawn of a picture, and moves of the camera
- pair: the picture A, which goes on beside B
- messages: what the window tells and asks
- files: what is open, and where it is saved
- camera_moves: the camera, by mouse and keys
- app: what the window's parts share
- panels: what the user sees and edits
- window: the loop, and how it ends
"""
