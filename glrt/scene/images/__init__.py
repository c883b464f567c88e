"""Image files as arrays.

Modules, each importing only what stands above it:

- float_images: OpenEXR files, and what all images are held to
- radiance: Radiance .hdr files
- image_files: image files of any format as linear values
- texture_sizes: textures scaled down to the limits of a driver
"""
