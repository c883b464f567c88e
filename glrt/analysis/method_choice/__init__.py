"""The cheapest method, and the fewest bounces, that reach an error; and whether particles pay.

Modules, each importing only what stands above it:

- work: what a sample costs, counted
- candidate: what is known of a method
- trial: bias, variance and work of the methods, measured on a small frame
- search: the choice of bounces and method
- denoised: whether fewer samples suffice once they are denoised
- advice: the result in words, for the commands
- caustics: whether particles from lamps are worth their work, and how many
"""
