"""Sweeps of light in volumes.

Modules, each importing only what stands above it:

- media: depth, turns, colours and bounds of media
- marching: grids that are crossed in steps
- overlaps: volumes that overlap by priority
"""
