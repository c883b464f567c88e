"""Bars above and below the picture.

Modules, each importing only what stands above it:

- toolbar: files, the view, and what is changed most often
- status: messages and figures
- framed: the picture between its bars
"""
