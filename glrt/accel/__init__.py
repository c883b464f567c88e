"""Acceleration structures: a tree over spheres, clusters of lamps. Arrays in, arrays out.

Modules, each importing only what stands above it:

- bvh: a bounding volume hierarchy over boxes
- sphere_nodes: the tree over spheres as the kernel reads it
- light_clusters: clusters of nearby lamps, and alias tables to draw one of many
"""
