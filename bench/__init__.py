"""Measurements of speed, memory and noise, of glrt and of its rivals. Not part of the wheel.

Programs, `python -m bench.NAME`; `--help` tells what they take:

- against: is this checkout slower than another commit?
- gpu: every way to render on this machine, against the first: the one for a new GPU
- scenes: scenes drawn from a seed, as files
- kernels: how fast the kernel is, and what its variants give
- efficiency: what each switch of a render buys, in noise and in time
- steps: what each step gives that leads from plain light sampling to the defaults
- many_lamps: what it gives to weigh lamps by nearness where there are many
- sphere_counts: what a tree over the spheres gives, for more and more of them
- node_visits: how many nodes of the tree a ray looks at
- roofline: how near the kernel comes to what the machine can compute
- dispatches: how long the driver works without a pause
- memory: how much memory a picture takes, and what for
- rivals: time to an error of 2 %, against other renderers
- calibration: whether the error that a picture claims is the true one
- false_alarms: how often `glrt compare` calls equal pictures different, and what it finds
- window_tour: the window, driven by a script and timed
- gallery: every scene that comes with glrt, as pictures and a page of them
- weekend: writes scenes/weekend.toml

What they share:

- program: options, the machine in words, and errors in one paragraph
- shader_edits: kernels whose shader text differs from glrt's
- processes: programs that stay and answer over pipes
- peer: other renderers as such programs
- against_side: one side of `against`, which may import a much older glrt
- gpu_way: one way to render, tried in a process for `gpu`
- checkouts: another commit as a folder, for a while
- ratios: ratios of times from rounds, with intervals
- contest: one renderer against another, from many short renders
- cold_start: how long a cold process takes to its first picture
- contact_sheet: pictures in rows
- screens: X servers without a screen
- dice: chance that is the same on every machine
- placing: where things stand in a scene by chance
"""
