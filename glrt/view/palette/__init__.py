"""A box that finds controls and commands by words.

Modules, each importing only what stands above it:

- matching: entries that match words, the best first
- entries: all controls and commands at present
- box: the box over the picture
"""
