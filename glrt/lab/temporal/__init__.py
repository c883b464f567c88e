"""Sweeps of what is shown from frame to frame.

Modules, each importing only what stands above it:

- live_probes: light after a step, rooms of any size
- moving: history while the camera, an object or the light moves
- posing: history of a mesh that bends
- still_pixel: what temporal modes make of a still pixel
"""
