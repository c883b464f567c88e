"""USD files: https://openusd.org. A process of its own turns one into the content of a .glb file.

The library reads damaged files with crashes and without end, so that process alone imports it:
`conversion` and the modules before it run there, and `process` and `document` in glrt itself.

Modules, each importing only what stands above it:

- reports: parts of a file that are left out, by kind
- layers: layers of a file, from its folder alone
- texture_tables: textures of materials
- looks: materials, as tables of a scene
- polygons_of_prims: polygons of meshes and of simple solids
- primitives: polygons as primitives of a glTF file
- lamps: lights, as tables of a scene
- cameras: cameras, and their lenses
- motion: motion, as an animation of a glTF file
- placing: where things stand, and instances
- conversion: a file as the content of a .glb file
- process: runs the conversion
- document: the converted file, and what glTF cannot hold
"""
