"""Single paths, recorded and replayed.

Modules, each importing only what stands above it:

- values: paths as values
- records: reader of recorded paths
- recorder: kernel that records paths
- replay: samples of single pixels, traced again
- file: paths as JSON, and the first difference of two
"""
