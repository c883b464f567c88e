"""Image files as arrays.

Modules, each importing only what stands above it:

- codes: codes of images as linear values
- float_images: OpenEXR files, and what all images are held to
- radiance: Radiance .hdr files
- metadata: PNG and JPEG files without their metadata
- image_files: image files of any format as linear values
- texture_sizes: textures scaled down to the limits of a driver
"""
