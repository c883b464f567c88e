"""Experiments over the renderer that are part of the product.

Modules, each importing only what stands above it:

- reference: what a picture should be
- variants: the ways to render a scene
- plot: the style of charts
- chart: error against time of every method
- method_choice: the cheapest method that reaches an error
- stress: sweeps into where methods fail
"""
