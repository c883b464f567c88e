"""Fields of a scene, and their checks.

Modules, each importing only what stands above it:

- fields: fields of a scene
- phrases: words for mistakes
- validation: mistakes in a scene, in words
- tables: a scene as plain tables and as TOML
"""
