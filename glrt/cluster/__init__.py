"""Frames and pictures rendered by the workers of a cluster of Dask's `distributed`.

Modules, each importing only what stands above it:

- addresses: where a cluster is: `local:N`, `tcp://HOST:PORT` or Dask's scheduler file
- worker: a worker's job, kept between tasks with its OpenGL
- entry: the function that workers run, also those without glrt
- clusters: opens a cluster, or starts a local one
- crew: gives tasks to workers, and yields each answer once
- films: frames of a film, by workers
- kept_bands: bands that stand until the picture is written
- bands: a picture as bands of rows, by workers
"""
