"""The fastest method, and the fewest bounces, that reach an error.

Modules, each importing only what stands above it:

- trial: bias, variance and time of the methods, measured on a small frame
- search: the choice of bounces and method
- advice: the result in words, for the commands
"""
