"""Values and pure functions behind the window; nothing here draws.

Modules, each importing only what stands above it:

- keys: names and meanings of keys
- live_probes: probes kept between pictures
- preferences: preferences of the user
- folders: contents of a folder
- recent: recently opened files
- preview_size: size of the preview during edits
- preview_noise: whether a preview is too noisy to read
- frame_budget: render time per frame
- layer_limits: whether a driver has room for layers
- compile_ahead: a kernel compiled by another process
- awaited_kernel: an edit that waits for its kernel
- idle_kernel: when the faster kernel takes over
- zoom: visible part of the picture
- histogram: histogram of brightness
- moving_picture: picture while the camera moves
- upsampled_work: coarse pictures of full size
- shown_picture: whether the picture is whole or coarse
- path_explorer: paths of a pixel
- session: scene, settings and their renderer
- denoise_process: a denoiser in a process of its own
- denoised_picture: denoised picture while rendering goes on
- costs: current cost of each edit
- reference_image: the reference picture
- error_history: error over time, and whether it is reached
"""
