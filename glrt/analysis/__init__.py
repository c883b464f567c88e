"""Experiments over the renderer that are part of the product.

Modules, each importing only what stands above it:

- path_report: paths of a pixel as text
- reference: the true radiance, as well as it is known
- variants: the methods and settings that are compared
- plot: the style of charts
- outputs: where charts go
- chart_page: a page of charts that needs no network
- chart: error against time for every method
- motion: what is on the screen while something moves, and its error
- method_choice: the cheapest method that reaches an error
- simplification: a smaller scene with the same picture, up to an error
"""
