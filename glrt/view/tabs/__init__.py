"""The panel of controls, in tabs.

Modules, each importing only what stands above it:

- bar: what does not scroll
- kept: rows of settings and preferences
- paths: how light is followed
- render: samples, size and display of the picture
- camera: the camera, and what is shown while it moves
- options: preferences of the window
- sections: parts of each tab
- panel: the tab that is shown
"""
