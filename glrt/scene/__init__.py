"""Frozen models of what is rendered, and scene files.

Modules, each importing only what stands above it:

- values: numbers, vectors and colours with their ranges
- camera: where a scene is seen from
- background: light from infinity
- materials: what surfaces are made of
- shapes: what there is to see
- scene: all of it together, and whether the parts fit
- validation: what is wrong with a scene file, in words
- toml: scene files read
- toml_writer: scene files written, with their comments kept
- catalog: the scenes that come with glrt, by name
- limits: what lies beyond float32 or the model: cautions
"""
