"""Scenes as files of other programs.

Modules, each importing only what stands above it:

- left_out: what a file cannot hold, in words
- image_codes: texels as codes of 8 bits
- triangles: shapes as triangles
- gltf_textures: textures of a glTF file that is written
- gltf_materials: materials of a glTF file that is written
- gltf: scenes as glTF files
- placing: directions, and the coordinates in which another program gets a scene
- faces: balls that are seen from inside
- meshes: meshes of a scene as other programs read them
- sky_maps: the radiance of the sky in any direction
- tints: media, and tinted glass as media
- companions: files that lie next to a scene file
- mitsuba: scenes of Mitsuba 3
- pbrt: scenes of pbrt-v4
"""
