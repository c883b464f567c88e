"""USD files: https://openusd.org. `conversion` turns one into the content of a .glb file.

It runs in a process of its own, as said in `glrt.scene.model_files.conversion`.

Modules, each importing only what stands above it:

- layers: layers of a file, from its folder alone
- images: images of materials and lights
- nodes: nodes of materials
- looks: materials, as tables of a scene
- polygons_of_prims: polygons of meshes and of simple solids
- primitives: polygons as primitives of a glTF file
- lamps: lights, as tables of a scene
- cameras: cameras, and their lenses
- motion: motion, as an animation of a glTF file
- placing: where things stand, and instances
- conversion: a file as the content of a .glb file
"""
