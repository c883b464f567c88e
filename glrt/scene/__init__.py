"""Frozen models of what is rendered, and scene files.

Modules, each importing only what stands above it:

- values: numbers, vectors and colours with their ranges
- animation: values that change from frame to frame
- meshes: triangle meshes as arrays
- files: files that a scene names by their path
- camera: the camera
- images: image files as arrays
- shapes: shapes, one file for each kind
- lights: background, sun, clear sky, and the cone of a lamp
- materials: materials, one file for each type
- model_files: files of models: glTF, USD, OBJ, PLY and STL
- density: grids by which the density of a medium varies
- transfer: transfer functions of scientific volumes
- medium: media between surfaces
- probes: grid of probes
- schema: fields of a scene, and their checks
- frames: a scene with other values in it
- instancing: meshes that share a BVH
- crossing_glass: solids that cross, share a face or lie inside each other
- volumes: media inside and outside of objects
- grids: places of grids in the world
- loading: loads the files that a scene names
- nesting: glasses that overlap by priority
- misfits: parts that do not go together
- twins: objects that coincide
- lit_scene: the light of a scene: groups, and what emits how much
- scene: the scene, with checks across its parts
- coincidence: lamps that coincide with other surfaces
- nameless: scenes compared without the names of their parts
- studio: light and ground for models without light
- model_scene: scenes of model files
- scenefile: scene files (TOML), read and written
- glasses: glasses of a scene, and the glass around its camera
- summary: contents of a scene in words
- file_warnings: warnings about files that a scene names
- export: scenes as files of other programs
- warnings: warnings about numbers and limits of the model
"""
