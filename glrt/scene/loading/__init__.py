"""Load the files that a scene names.

Modules, each importing only what stands above it:

- companions: files that another file names by their paths
- file_contents: contents of named files
- file_materials: materials in OBJ and glTF files
- mesh_parts: meshes divided by the materials of their file
- file_camera: motion and shape of the picture of a camera in a file
- scene_files: a scene with all its files loaded
- file_copies: copies of the files of a scene
"""
