"""A film, AOVs and probes drawn for the screen.

Modules, each importing only what stands above it:

- probe_balls: probes drawn over a picture
- display: display pass: exposure and tone curve
- false_colors: numbers as false colours
- aov_view: AOVs as colours
- magnifier: enlarged pixels
- surface_view: first surface under simple light
"""
