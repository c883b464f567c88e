"""OpenGL alone: it knows no scene.

Modules, each importing only what stands above it:

- osmesa: Mesa's software renderer in plain memory
- xlib: X servers that go away
- context_turns: contexts that take turns in one thread
- context: routes to an OpenGL context: EGL, OSMesa, a hidden window
- structs: GLSL structs read as numpy dtypes
- glsl: shader files put together into what the driver gets
- struct_arrays: how a kernel reads an array: constants, uniform block or texture
- program: a compiled program, its blocks and images bound by name
- canvas: a texture that is drawn on
- shared_resources: buffers and textures with several users
- evaluate: single GLSL functions over arrays
- driver_checks: what the driver really does: loop limit, rounding, `precise`
"""
