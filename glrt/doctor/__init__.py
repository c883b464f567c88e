"""Test which OpenGL routes work on a machine.

Modules, each importing only what stands above it:

- route_process: one route tried in a process of its own
- install_hints: what to install, by system
- report: every route, and what to do
"""
