"""Whether two pictures differ by more than their noise.

Modules, each importing only what stands above it:

- noise: what chance can do to a difference
- result: what was found
- verdict: same, different or undecided
- heatmap: a picture of the difference
"""
