"""Scenes of glrt rendered by Mitsuba 3: a third opinion, and a rival in the benchmark.

`python -m tests.mitsuba SCENE -o FILE.exr` is a program of its own, since Mitsuba ends the process
with some versions of LLVM. docs/results/crosscheck.md says where the two renderers differ.
"""
