"""Files that a scene names by their path.

Modules, each importing only what stands above it:

- path_text: names of files as text
- assets: reads files inside the folder of a scene, with their hashes
- named_files: files named by a path
- named_images: images named by a path
- named_meshes: meshes named by a path
- named_cameras: cameras named by a path
- vdb_grids: grids of OpenVDB files
- nvdb_grids: grids of NanoVDB files
- named_grids: grids of densities named by a path
"""
