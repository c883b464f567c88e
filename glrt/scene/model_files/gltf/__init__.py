"""glTF 2.0 files: https://registry.khronos.org/glTF/specs/2.0/glTF-2.0.html.

Modules, each importing only what stands above it:

- document: JSON and buffers of a file
- accessors: arrays of a file
- coordinates: sets of texture coordinates
- draco: meshes compressed by Draco
- attributes: vertex attributes of primitives
- nodes: placements of meshes, cameras and lights
- variants: variants of materials
- skins: vertices moved by joints
- primitives: triangles of primitives
- animations: animations of nodes, skins and morph targets
- images: embedded and external images
- textures: textures, as tables of a scene
- materials: materials, converted to those of a scene
- cameras: cameras, and how they move
- lights: lights, converted to those of a scene
"""
