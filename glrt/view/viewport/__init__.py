"""What is drawn of a picture, and moves of camera and objects.

Modules, each importing only what stands above it:

- picture: the film as a texture for Dear ImGui
- views: the views of a render
- difference: how far the picture is from the kept one
- orbit: moves of the camera
- pick: what lies under a point
- black: why nothing but black is seen
- outline: where an object ends in the picture
- path_lines: paths as lines, and a camera outside
- transform: moves of shapes
- picture_view: a view, and the kept picture beside it
"""
