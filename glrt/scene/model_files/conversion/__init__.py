"""Files that a library reads in a process of its own, which makes the content of a .glb file.

The libraries read damaged files with crashes and without end, so that process alone imports them.

Modules, each importing only what stands above it:

- reports: parts of a file that are left out, by kind
- folder: where the files lie that a file names, and which of them may be read
- outcome: what the process of its own writes
- process: runs that process
- document: the converted file, and what glTF cannot hold
"""
