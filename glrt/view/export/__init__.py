"""Pictures and films that leave the window.

Modules, each importing only what stands above it:

- wishes: what is to be exported, as typed, and as a command
- sources: the present view as a picture that a command renders again
- jobs: another process that renders a picture or a film
- clipboard: a picture on the clipboard of the desktop
- exports: the export that is under way
"""
