"""Values of a scene that change from frame to frame.

Modules, each importing only what stands above it:

- rotations: quaternions as angles
- interpolation: values between keys
- tracks: the `[animation]` table of a scene file
"""
