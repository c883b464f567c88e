"""Estimates of the error of a picture, and how far they can be believed.

Modules, each importing only what stands above it:

- neighbours: the brightest of the pixels beside each
- estimate: relative error of a picture, means and standard errors of blocks; the standard error
  of a pixel is read from the film (glrt/rendering/film.py)
- seen_lamps: pixels that lamps fill in part, and what they show in truth
- reliability: whether the error is to be believed, by pixels that few samples lit
- judgement: the same of a picture of a scene, by what the scene tells too
"""
