"""Shapes with their geometry on the host, one file for each kind.

Modules, each importing only what stands above it:

- faces: flat faces and their edges, for outlines
- flat_faces: flat faces of solids, to find two that share a part of a plane
- texture_axes: axes of texture coordinates of flat shapes
- base: base classes of shapes
- box: boxes
- mesh_values: factors and matrices of meshes
- mesh_rays: rays and points against triangles
- mesh: placed triangle meshes
- cylinder: cylinders, with caps or open
- flat_polygons: flat surfaces of objects as polygons
- disk: flat disks
- plane: infinite planes
- quad: parallelograms
- sphere: spheres
- kinds: all kinds of shapes
"""
