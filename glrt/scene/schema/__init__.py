"""Fields of a scene, and their checks.

Modules, each importing only what stands above it:

- fields: fields of a scene
- validation: mistakes in a scene, in words
- tables: a scene as plain tables and as TOML
"""
