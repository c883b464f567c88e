"""Error against time for every method.

Modules, each importing only what stands above it:

- rays: number of rays per sample
- flip: perceived difference of two pictures
- measure: interleaved rounds of all variants
- saved_rounds: measured rounds in a file
- curves: statistics of the rounds: error, intervals, slope, bias
- experiment: the measurement of one scene
- page: the results as sentences and tables
- drawing: the chart of one scene
- files: charts, page, CSV and JSON
"""
