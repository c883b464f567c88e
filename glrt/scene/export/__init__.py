"""Scenes as files of other programs.

Modules, each importing only what stands above it:

- triangles: shapes as triangles
- gltf_file: JSON and buffer of a glTF file that is written
- gltf_textures: textures of a glTF file that is written
- gltf_materials: materials of a glTF file that is written
- gltf: scenes as glTF files
"""
