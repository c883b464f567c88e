"""Estimates of the error of a picture, and how far they can be believed.

Modules, each importing only what stands above it:

- estimate: relative error of a picture, means and standard errors of blocks; the standard error
  of a pixel is read from the film (glrt/rendering/film.py)
- reliability: whether the error is to be believed, by pixels that few samples lit
"""
