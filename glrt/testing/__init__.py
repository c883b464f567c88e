"""A pytest plugin that compares pictures with references.

Modules, each importing only what stands above it:

- pictures: render, compare, keep references
- plugin: the hooks and the fixture of pytest
"""
