"""Drawing of the picture, and moves of camera and objects.

Modules, each importing only what stands above it:

- picture: the film as a texture for Dear ImGui
- views: the views of a render
- difference: numbers of the difference from the kept picture
- orbit: moves of the camera
- sides: views of the whole scene from its sides
- pick: the object under a point of the picture
- black: why the picture is black
- outline: outline of an object in the picture
- silhouette: the line around meshes in the picture
- path_lines: paths as lines, and a camera outside
- transform: moves of shapes
- picture_view: a view of the render, with the kept picture
"""
