"""OpenGL alone: it knows no scene.

Modules, each importing only what stands above it:

- osmesa: Mesa's software renderer in plain memory
- xlib: X servers that go away
- context_turns: contexts that take turns in one thread
- structs: GLSL structs read as numpy dtypes
- glsl: shader files put together into what the driver gets
- program: a compiled program, its blocks and images bound by name
- programs: compiled programs that users of a context share
- context: routes to an OpenGL context: EGL, OSMesa, a hidden window
- struct_arrays: how a kernel reads an array: constants, uniform block or texture
- canvas: a texture that is drawn on
- shared_resources: buffers and textures with several users
- evaluate: single GLSL functions over arrays
- driver_checks: what the driver really does: loop limit, rounding, `precise`
"""
