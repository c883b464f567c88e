"""Error against time of every method.

Modules, each importing only what stands above it:

- rays: rays a sample takes
- flip: how different two pictures look
- measure: every variant in every round
- rounds: rounds kept in a file
- curves: what rounds say: slopes, bias, intervals
- experiment: one scene measured
- words: what a chart shows, in words
- drawing: the chart of one scene
- files: pictures, page, CSV and JSON
"""
