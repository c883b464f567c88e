"""Error against time for every method.

Modules, each importing only what stands above it:

- rays: number of rays per sample
- flip: perceived difference of two pictures
- measure: interleaved rounds of all variants
- curves: statistics of the rounds: error, intervals, slope, bias
- sights: parts of pictures that show how errors look
- experiment: the measurement of one scene
- choice: the few curves that a picture shows
- labels: places for labels that cover neither each other nor curves
- page: the results as sentences and tables
- drawing: the picture
- sections: the results as sections of a page that needs no network
- files: charts, page, CSV and JSON
"""
