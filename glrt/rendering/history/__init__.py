"""Samples of earlier views on the screen while the camera moves.

Modules, each importing only what stands above it:

- drawn_pass: a fragment shader over all pixels
- gbuffer: first surface of each pixel (G-buffer)
- reprojection: an earlier view projected to the current one
- history_filter: interface of the temporal modes
- taa: temporal antialiasing
- ataa: adaptive temporal antialiasing
- wrls: weighted recursive least squares
- temporal: picture on the screen while the camera moves
"""
