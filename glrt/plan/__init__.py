"""Which kernel a scene and its settings need, and what a method leaves out.

Modules, each importing only what stands above it:

- methods: table of methods
- facts: counts of what a scene holds, and its BVHs
- lamp_sides: share of particles from each side of a lamp
- particles: targets of particles, and scenes that cannot have them
- probe_grid: positions of probes
- features: features compiled into a kernel
- explanation: why each feature is compiled in
- plan: the plan of a render: features and light layers
- combinations: table of options that work together
- omissions: light that a method leaves out
- slow_scenes: reasons why a scene is slow, if the user can change them
"""
