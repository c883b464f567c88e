"""A smaller scene that shows the same picture up to a given error, for `glrt inspect --simplify`.

Modules, each importing only what stands above it:

- parts: parts that a scene can do without, and the scene without them
- difference: how much a picture changes, with a bound
- order: objects and lamps by how much they show
- search: the parts that go together
- report: the result in words
"""
