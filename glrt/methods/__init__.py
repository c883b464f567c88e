"""What a method and a scene need of a kernel, and what a method leaves out.

Modules, each importing only what stands above it:

- table: the methods, a row each
- contents: what is in a scene, and by which trees shapes are found
- lamp_sides: how many particles leave each side of a lamp
- particles: where particles from lamps go, and where they cannot
- probe_grid: where the probes of a scene stand
- features: the features compiled into a kernel
- explanation: why each of them is, in words
- light_layers: light as a weighted sum of layers
- combinations: what goes with what
- omissions: what a method leaves out of a scene
- slowness: why a scene is slow, where the user can change it
"""
