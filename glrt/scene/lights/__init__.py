"""Light from the background, and the cone of a lamp.

Modules, each importing only what stands above it:

- clear_sky: clear sky for a direction of the sun
- background: light from infinity
- cone: directions in which a lamp emits
- sun: a disc at infinity
- sky_image: image of the sky in all directions
"""
