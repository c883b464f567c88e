"""What is on the screen while the camera or the light moves, and its error.

Modules, each importing only what stands above it:

- sequences: the scenes of a moving picture, frame by frame
- playing: what a temporal mode shows of them
- measure: its error, frame by frame
- report: charts, a table, a page
"""
