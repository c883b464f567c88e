"""Estimates of the error of a picture, and how far they can be believed.

Modules, each importing only what stands above it:

- brightest_neighbour: the brightest pixel around each pixel
- estimate: relative error of a picture, means and standard errors of blocks; the standard error
  of a pixel is read from the film (glrt/rendering/film.py)
- seen_lamps: true radiance of pixels that lamps fill in part
- reliability: whether the error can be believed, by pixels that few samples lit
- reliability_of_scene: reliability of the error, from the picture and its scene
"""
