"""Reports of pictures: on the way, and at the end.

Modules, each importing only what stands above it:

- warnings: warnings about a finished picture
- render_report: report of a finished render
- progress: the progress bar
- cluster_report: workers of a cluster, and their progress
- film_report: report of a film
"""
