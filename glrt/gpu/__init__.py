"""OpenGL contexts, shaders and buffers, without knowledge of scenes.

Modules, each importing only what stands above it:

- osmesa: Mesa's software renderer in plain memory
- xlib: survives the loss of an X server
- context_turns: contexts that take turns in one thread
- structs: GLSL structs read as numpy dtypes
- branch_nodes: nodes of the tree of a shader function: conditions, calls
- branches: parses a shader function into this tree
- constant_values: expressions whose value constants decide
- live_code: leaves out what cannot run
- glsl: shader files put together into what the driver gets
- program: a compiled program, its blocks and images bound by name
- raster_kernel: a program that draws vertices into a depth buffer
- programs: compiled programs that users of a context share
- context: routes to an OpenGL context: EGL, OSMesa, a hidden window
- constant_arrays: GLSL of arrays that are constants, and of loops over them
- struct_arrays: how a kernel reads an array: constants, uniform block or texture
- depth_texture: a depth buffer of floats
- canvas: textures that are drawn on
- shared_resources: buffers and textures with several users
- evaluate: single GLSL functions over arrays
- driver_checks: measured behaviour of the driver: loop limit, rounding, `precise`
"""
