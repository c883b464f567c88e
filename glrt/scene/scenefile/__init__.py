"""Scene files (TOML), read and written.

Modules, each importing only what stands above it:

- catalog: scenes that come with glrt
- toml: reads scene files
- toml_lists: adds and removes objects in the text of a scene file
- toml_writer: writes scene files, and keeps their comments
"""
