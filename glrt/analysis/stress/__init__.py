"""Sweeps into the places where methods fail.

Modules, each importing only what stands above it:

- noisy_scenes: little noise, rare and large hits
- scenes: scenes in a few words
- sweep: a parameter, what was measured, and what is guaranteed
- rays: rays from afar, at every scale
- lamps: small, many and hidden lamps
- glass: glass and caustics
- sums: long sums
- views: cameras and pixels
- cases: all cases by name
- report: table, figures and overview
"""
