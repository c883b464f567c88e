"""The cheapest method, and the fewest bounces, that reach an error.

Modules, each importing only what stands above it:

- trial: one scene tried by many methods
- search: what suffices
- advice: the verdict in words
"""
