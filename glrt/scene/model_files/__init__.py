"""Files of models: glTF, OBJ, PLY and STL.

Modules, each importing only what stands above it:

- gltf: glTF files
- mesh_formats: mesh files as arrays
- mtl: materials of OBJ files
"""
