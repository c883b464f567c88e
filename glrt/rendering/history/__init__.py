"""Samples of earlier views on the screen while the camera moves.

Modules, each importing only what stands above it:

- drawn_pass: a fragment shader over all pixels
- motion: how objects moved between two views
- deformed: where surfaces of posed meshes were before
- gbuffer: first surface of each pixel (G-buffer)
- reprojection: an earlier view projected to the current one
- history_filter: interface of the temporal modes
- reproject: history and film by their numbers of samples
- taa: temporal antialiasing
- listed_pixels: samples of listed pixels alone
- ataa: adaptive temporal antialiasing
- wrls: weighted recursive least squares
- lattice: which pixels of a coarse picture are sampled
- upsample: temporal upsampling of coarse pictures
- temporal: picture on the screen while the camera moves
"""
