"""Which OpenGL routes work on a machine.

Modules, each importing only what stands above it:

- route_process: one route tried in a process of its own
- install_hints: what to install, by system
- lacks: what glrt could do, but not on this machine
- report: every route, and what to do
"""
