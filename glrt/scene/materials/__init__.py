"""Materials of surfaces, one file for each type.

Modules, each importing only what stands above it:

- facets: energy lost between the facets of rough glass
- gloss: reflectance of the facets of principled surfaces
- sheen: light that the sheen of cloth reflects
- thin_film: iridescent films on facets
- textures: images and checkerboards for colors and numbers
- conductors: metals by their complex index of refraction
- base: base classes of materials
- dielectric: glass and liquids
- principled: glTF's metallic-roughness material
- lambertian: matte surfaces
- light: surfaces of lamps
- metal: metal surfaces
- nothing: bounds of volumes that are no surface
- kinds: all types of materials
"""
