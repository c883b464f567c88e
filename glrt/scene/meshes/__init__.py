"""Triangle meshes as arrays.

Modules, each importing only what stands above it:

- vertex_means: normals and tangents of vertices
- creases: normals at corners, where edges may be sharp
- rounded_edges: where interpolated normals round sharp edges off
- repeated_triangles: triangles that a mesh holds twice
- triangle_meshes: triangle meshes, their normals and volumes
- checked_meshes: meshes from arrays, after a check
"""
