"""Fields of a scene, and their checks.

Modules, each importing only what stands above it:

- fields: fields of a scene
- models: models of tables, and the one that a key belongs to
- phrases: words for mistakes
- validation: mistakes in a scene, in words
- tables: a scene as plain tables and as TOML
"""
