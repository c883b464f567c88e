"""Acceleration structures: trees over shapes, clusters of lamps. Arrays in, arrays out.

Modules, each importing only what stands above it:

- binned_splits: divides boxes between the children of a node
- bvh: a bounding volume hierarchy over boxes, with a box in each node
- sphere_nodes: the tree over spheres as the kernel reads it
- binary_tree: a tree over boxes, with a box in each leaf
- wide_tree: a BVH with 8 children a node, in slots as the kernel reads them
- triangle_pairs: neighbouring triangles, two in a leaf
- split_boxes: boxes around triangle pairs, cut where they are mostly empty
- shape_tree: the tree over shapes, and what stands in its leaves
- light_clusters: clusters of nearby lamps, and alias tables to draw one of many
"""
