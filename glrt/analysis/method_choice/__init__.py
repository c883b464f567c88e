"""The cheapest method, and the fewest bounces, that reach an error.

Modules, each importing only what stands above it:

- work: what a sample costs, counted
- trial: bias, variance and work of the methods, measured on a small frame
- search: the choice of bounces and method
- advice: the result in words, for the commands
"""
