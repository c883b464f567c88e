"""A scene and settings in, samples on a film out.

Modules, each importing only what stands above it:

- kernel_structs: structs and constants that host and kernel share
- pack_shapes: shapes as rows, a packer for each kind
- aims: where lamps can be seen from
- lamp_bodies: where lamps are and how far they reach
- tree_cache: what takes long to build, kept on the disk
- pack_details: what some materials have beyond their row
- pack_materials: materials as rows, a packer for each type
- pack_mesh: triangles of meshes, in the frame of the tree
- pack_instances: meshes with a tree of their own, and where they stand
- pack_tree: the tree over shapes, a packer of leaves for each kind
- pack_lights: lamps as rows of the kernel's blocks
- pack_maps: images on surfaces, and where they lie on shapes
- pack_particles: what particles from lamps read
- pack: a scene as arrays for the kernel
- passes: what runs over the pixels of a picture, as values
- texel_texture: the texels of images on surfaces
- pipelines: compute or fragment shader
- image_texture: an image of a scene as a texture
- sky_table: the image of the sky as a tree by which it is sampled
- evaluation: functions of the path tracer over arrays
- schedule: how much work a dispatch takes
- device_scene: a scene in the driver's memory, and the kernel source that reads it
- kernel_switch: a generic kernel and a faster one by turns
- pass_film: what a pass adds samples to
- film: running mean and variance in textures
- aov_tracer: gathers AOVs as the picture grows
- particle_tracer: gathers what particles from lamps bring
- tracer: adds samples to a film, a dispatch at a time
- path_values: paths of a pixel as values
- path_records: what a replay writes down, read as such
- path_recorder: the kernel that writes it down
- path_replay: samples of single pixels traced again
- path_file: paths as JSON, and where two of them differ
- weighting: a film's layers under weights
- display: the display pass
- false_colors: numbers of pixels as colours
- aov_view: AOVs as colours
- magnifier: part of a picture with sharp pixels
- surface_view: the first surface under simple light
- progress: what a render tells of itself
- halver: keeps the first half of a render, for a denoiser
- renderer: scene and settings to samples, step by step
- stopping: render to a limit of samples, time or error
- parts: a merged picture rendered again
"""
