"""glTF 2.0 files: https://registry.khronos.org/glTF/specs/2.0/glTF-2.0.html.

Modules, each importing only what stands above it:

- document: the parts of a file, and its buffers
- accessors: its arrays
- draco: the same, unpacked
- attributes: what the primitives of its meshes have of each vertex
- nodes: where its meshes, cameras and lights stand
- skins: where joints lead the vertices of its meshes
- primitives: the triangles of its meshes
- images: the images that it holds or names
- textures: its textures in the terms of a scene
- looks: its materials in the terms of a scene
- stage: its cameras and lights in the terms of a scene
"""
