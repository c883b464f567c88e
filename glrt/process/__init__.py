"""The process of a command: signals, standard streams, time and memory.

Modules, each importing only what stands above it:

- early: Ctrl-C before anything else is imported
- signals: Ctrl-C, SIGTERM and SIGHUP
- command: standard streams, age and memory of the process
- silence: suppresses output of compiled libraries
- load: frames a second, share of processors and GPU
"""
