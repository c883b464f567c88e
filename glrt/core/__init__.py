"""Small tools that every other package uses.

Modules, each importing only what stands above it:

- version: version of glrt
- text: words and numbers in messages
- errors: error classes, with their exit codes
- resources: folders of shaders and scenes, and of the user
- files: atomic writes: a file is complete or absent
- install: the command that installs an optional package
- web_page: pages that need no network
- threads: parts of a computation in several threads
- stages: stages of long work, reported to who waits for it
- memo: caches of properties, and of results by the identity of the arguments
- same_rows: whether arrays hold the same bits
- box_pairs: pairs of boxes that touch, among many
"""
