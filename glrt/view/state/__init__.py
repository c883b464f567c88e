"""Values and pure functions behind the window; nothing here draws.

Modules, each importing only what stands above it:

- controls: what a widget must know of a value
- explanations: what a control changes, with its equation
- scene_edits: objects and materials added, copied, renamed, removed
- new_objects: what is added, and where
- keys: names of keys and what they mean
- live_probes: whether probes go on from picture to picture
- preferences: what a user wants of any window
- folders: what a folder holds
- recent: what was opened last
- edited: what undo brings back
- changes: what parts two states, in words
- history: undo and redo
- editing: what is wanted now, and before
- preview_size: how coarsely edits in a row are shown
- grain: whether a coarse picture can be read
- frame_budget: how long a frame may render
- layer_limits: whether a driver has room for layers
- idle_compile: a kernel compiled ahead by another process
- idle_kernel: when the faster kernel takes over
- zoom: how much of the picture is seen
- histogram: how bright it is
- moving_picture: what is shown beside the film while the camera moves
- path_explorer: the paths of a pixel
- session: the scene, its settings and the renderer that follows them
- denoise_process: a filter in a process of its own
- denoised_picture: the picture filtered while it is rendered on
- costs: what an edit costs at present
- reference_image: the picture kept to compare with
- error_history: how the error falls, and when it is small enough
"""
