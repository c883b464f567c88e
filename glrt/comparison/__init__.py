"""Whether two pictures differ by more than their noise.

Modules, each importing only what stands above it:

- regions: sums of pixels over the whole picture and over blocks
- noise: what chance can do to a difference
- sensitivity: how large a change would have been found
- own_numbers: the part of a picture whose pixels err independently
- result: the result of a comparison
- verdict: same, different or undecided
- heatmap: a picture of the difference
- html: a page of compared pictures
"""
