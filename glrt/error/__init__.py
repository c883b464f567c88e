"""Estimates of the error of a picture, and how far they can be believed.

Modules, each importing only what stands above it:

- estimate: relative error, block means, standard errors
- reliability: whether parts of a render differ as its error says
"""
