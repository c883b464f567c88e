"""Scenes of pbrt-v4 (https://pbrt.org/fileformat-v4). pbrt itself is not run by any test.

Modules, each importing only what stands above it:

- text: directives and parameters
- textures: images on surfaces
- materials: how surfaces scatter
- media: what lies inside and outside of surfaces
- skies: sky and sun
- shapes: shapes
- file: a scene as a file and its companions
"""
