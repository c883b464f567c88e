"""The screen that the window starts with if no scene is named.

Modules, each importing only what stands above it:

- thumbnails: small pictures of the scenes that come with glrt
- screen: the screen: scenes, recent files and `open`
"""
