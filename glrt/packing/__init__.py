"""A scene as arrays, buffers and textures on the driver.

Modules, each importing only what stands above it:

- kernel_structs: structs and constants of the kernel
- shapes: shapes as rows, one packer for each kind
- emission_cones: cones of directions in which lamps emit
- lamp_bounds: place and extent of each lamp
- tree_cache: disk cache of BVHs
- material_details: tables of materials that do not fit into their row
- materials: materials as rows, one packer for each type
- triangles: triangles of meshes, in the frame of the BVH
- instances: meshes with a BVH of their own, and their placements
- scene_tree: the BVH over shapes, one packer of leaves for each kind
- ready_tree: a BVH that was built before a renderer asks for it
- drawn_triangles: the order in which triangles are drawn
- lights: lamps as rows
- texture_maps: textures of materials, and texture axes of shapes
- texel_texture: texels of all textures
- voxel_texture: voxels of all grids, and the largest density in each brick
- media: media and the bounds of volumes
- particles: data for particles from lamps
- probes: data for probes
- phong: constants of Phong's model
- scene_arrays: all arrays of a scene, and the frame block
- image_texture: an image as a texture
- sky_table: importance table of the sky image
"""
