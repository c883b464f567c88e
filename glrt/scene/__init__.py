"""Frozen models of what is rendered, and scene files.

Modules, each importing only what stands above it:

- facets: what facets of rough glass lose to each other
- gloss: what the facets of principled surfaces reflect
- values: numbers, vectors and colours with their ranges
- assets: files that a scene names, held to its folder and hashed
- float_images: Radiance .hdr and OpenEXR files as arrays
- image_files: images in files, of any format, as arrays of linear values
- named_files: files that a scene names by a path
- named_images: images that a scene names by a path
- triangle_meshes: triangle meshes as arrays, checked
- mesh_formats: files of meshes as arrays
- named_meshes: meshes that a scene names by a path
- camera: where a scene is seen from
- clear_sky: a clear sky for a direction of the sun
- background: light from infinity
- objects: what every shape has
- cone: the directions that a lamp lights
- conductors: metals by their complex index of refraction
- surfaces: what all materials have
- dielectric: glass and liquids
- principled: glTF's metallic roughness
- materials: what surfaces are made of
- solids: shapes with faces that enclose a volume
- meshes: triangle meshes and their places
- cylinder: the round one of them, with ends or without
- shapes: what there is to see
- sun: a disc at infinity
- sky_picture: the image of all directions that a scene has
- contents: the fields of a scene
- validation: what is wrong with a scene, in words
- mtl_files: materials of OBJ files
- own_trees: which meshes have a tree of their own
- own_materials: meshes divided by the materials of their files
- loading: the files that a scene names, read into it
- tables: the parts of a scene as plain tables, and tables as TOML
- nesting: glasses that overlap by priority
- scene: all of it together, and whether the parts fit
- toml: scene files read
- toml_writer: scene files written, with their comments kept
- catalog: the scenes that come with glrt, by name
- glasses: the glasses of a scene, and what is around its camera
- summary: what a scene holds, in words
- flat_faces: whether solids share a part of a plane
- crossing_glass: how solids of glass lie to each other
- limits: what lies beyond float32 or the model: cautions
"""
