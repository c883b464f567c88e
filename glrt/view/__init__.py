"""The window of `glrt view`.

Modules, each importing only what stands above it:

- controls: range, unit and cost of a control
- opengl: OpenGL context of the window
- native: title, dropped files and full screen of the window
- style: theme and scale
- file_watch: files changed by other programs
- edits: edits of a scene and its settings, with undo
- event_wait: no frames while nothing changes
- state: values and pure functions behind the window
- figure_texts: figures of a picture as text
- widgets: widgets that several panels use
- file_dialogs: the desktop's file dialogs, or that of the window
- viewport: the picture, picking, and moves of the camera
- compared_picture: picture A, rendered next to B
- messages: messages and questions
- kernel_notes: notes on kernels that a driver keeps compiled
- scene_compiler: another process that compiles the kernel of a scene
- edit_compiler: another process that compiles the kernel of an edit
- opening: a large scene that a thread reads
- file_places: places of files
- picture_files: saved pictures and paths
- files: open and saved files
- recovery: unsaved edits kept for the next start
- export: pictures and films that leave the window
- kept_views: views that the user keeps
- timeline: frame of the animation that is shown
- camera_moves: the camera moved by mouse and keys
- selection: the selected object, and edits of objects
- app: state shared by the parts of the window
- outliner: a list of what the scene holds
- panels: the panels
- tabs: the panel of controls, in tabs
- start: the screen that is shown without a scene
- bars: bars above and below the picture
- boxes: boxes over the picture
- palette: a box that finds controls and commands
- window: main loop and shutdown
"""
