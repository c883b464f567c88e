"""Denoising with a known error: filters, and what they leave wrong; arrays in, arrays out.

It knows no picture, film, file or driver; pictures show its results.

Modules, each importing only what stands above it:

- windows: means over the neighbourhood of each pixel
- half: half of the samples of a picture, with what guides a filter
- nlm: joint non-local means
- oidn: Intel's Open Image Denoise
- filters: the filters by name, and which of them are installed
- blend: mixes in the unfiltered picture where a filter would make it worse
- risk: the mean squared error of a filtered picture, from two halves
- denoising: makes a denoised picture and its error from two halves
"""
