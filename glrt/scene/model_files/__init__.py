"""Files of models: glTF, USD, OBJ, PLY and STL.

Modules, each importing only what stands above it:

- gltf_file: JSON and buffer of a glTF file that is written
- gltf: glTF files
- text_lines: lines and numbers of files in text
- polygons: polygons, divided into triangles
- usd: USD files
- obj: OBJ files
- ply_header: headers of PLY files
- ply_tables: tables of PLY files
- ply: PLY files
- stl: STL files
- mesh_formats: mesh files as arrays
- mtl: materials of OBJ files
"""
