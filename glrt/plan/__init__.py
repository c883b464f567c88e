"""Which kernel a scene and its settings need, and what a method leaves out.

Modules, each importing only what stands above it:

- methods: table of methods
- media: facts about media and their bounds
- lobes: facts about how materials scatter light
- particles: targets of particles, and where particles start
- facts: facts that follow from a scene: counts, lamps, glasses, BVHs
- lamp_sides: share of particles from each side of a lamp
- probe_grid: positions of probes
- probe_weights: weight of each update of probes
- case: a scene with its settings
- reasons: why a feature is compiled in or left out, in words
- rows: rows of the table of features: when a kernel needs each
- features: features compiled into a kernel
- plan: the plan of a render: features and light layers
- explanation: why each feature is compiled in
- particle_refusals: why particles cannot be followed in a scene
- band_refusals: why pictures cannot be divided into bands
- shared_refusals: why some options do not go with random numbers that pixels share
- combinations: table of options that work together
- omissions: light that a method leaves out
- idle_settings: settings that are given and change nothing
- slow_scenes: reasons why a scene is slow, if the user can change them
"""
