"""The picture on the screen while the camera or the light moves, and its error.

Modules, each importing only what stands above it:

- sequences: the scenes of a moving picture, frame by frame
- playing: the pictures that a temporal mode shows of them
- clock: milliseconds of their frames
- measure: the error of these pictures, frame by frame
- report: charts, a table, a page
"""
