"""Denoising that knows its error: filters, and what they leave wrong; arrays in, arrays out.

It stands above the pictures, which show what it returns, and knows no film, file or driver.

Modules, each importing only what stands above it:

- windows: means over the neighbourhood of each pixel
- half: half of the samples of a picture, with what guides a filter
- nlm: joint non-local means
- oidn: Intel's Open Image Denoise
- filters: the filters by name, and which of them are installed
- blend: the picture as it was, where a filter would make it worse
- risk: the mean squared error of a filtered picture, from two halves
- denoising: two halves in, a picture and its error out
"""
