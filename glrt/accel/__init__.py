"""Trees over shapes and groups of lamps: arrays in, arrays out.

Modules, each importing only what stands above it:

- bvh: a bounding volume hierarchy over boxes
- sphere_nodes: the tree over spheres as the kernel reads it
- light_clusters: nearby lamps in groups, and tables to draw one of many
"""
