"""Files of models: glTF, USD, MaterialX, OBJ, PLY and STL.

Modules, each importing only what stands above it:

- gltf_file: JSON and buffer of a glTF file that is written
- gltf: glTF files
- text_lines: lines and numbers of files in text
- polygons: polygons, divided into triangles
- conversion: files that a library reads in a process of its own
- networks: networks of nodes, which give materials
- usd: USD files
- materialx: MaterialX files
- obj: OBJ files
- ply_header: headers of PLY files
- ply_tables: tables of PLY files
- ply: PLY files
- stl: STL files
- mesh_formats: mesh files as arrays
- mtl: materials of OBJ files
"""
