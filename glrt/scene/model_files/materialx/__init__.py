"""MaterialX documents: https://materialx.org. `conversion` makes a .glb file of one.

It runs in a process of its own, as said in `glrt.scene.model_files.conversion`.

Modules, each importing only what stands above it:

- documents: a document with its included documents
- nodes: nodes of a document, as nodes of a network
- balls: a ball for each material, and a camera
- conversion: a document as the content of a .glb file
"""
