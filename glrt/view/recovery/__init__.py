"""Unsaved edits kept in a file of the user, and offered again after a crash.

Modules, each importing only what stands above it:

- claims: locks of files that a running window has
- headers: first line of a recovery file, and where these files lie
- contents: the text of a recovery file, and the scene in it
- offers: files of windows that are gone
- keeper: writes and removes the file of this window
- question: the question whether edits are to be restored
- lost_display: a last save when the X server is gone
"""
