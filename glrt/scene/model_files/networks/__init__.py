"""Surfaces by networks of nodes, as MaterialX and USD have them, as principled materials.

https://materialx.org, https://openusd.org/release/spec_usdpreviewsurface.html

Modules, each importing only what stands above it:

- nodes: a node, whatever file it is from
- coordinates: how textures lie
- arithmetic: arithmetic with numbers and colors
- evaluation: values that nodes give, numbers or textures
- inputs: inputs of a surface, as values of a material
- preview_surface: UsdPreviewSurface
- layered: what Standard Surface and OpenPBR have in common
- standard_surface: Autodesk's Standard Surface
- open_pbr: OpenPBR Surface
- gltf_surface: glTF's surface as a node
- surfaces: the surfaces that are known, by their names
"""
