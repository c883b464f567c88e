"""Files of models: glTF, OBJ, PLY and STL.

Modules, each importing only what stands above it:

- gltf: glTF files
- text_lines: lines and numbers of files in text
- polygons: polygons, divided into triangles
- obj: OBJ files
- ply_header: headers of PLY files
- ply_tables: tables of PLY files
- ply: PLY files
- stl: STL files
- mesh_formats: mesh files as arrays
- mtl: materials of OBJ files
"""
