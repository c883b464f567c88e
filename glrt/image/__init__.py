"""Pictures in files, with their recipe and the state of their film.

Modules, each importing only what stands above it:

- tonemap: from radiance to the colours of a screen
- aovs: AOVs of a picture, in channels of a file
- allotment: samples of each pixel of an adaptive picture
- group_channels: the means of groups of shared numbers, and the error that follows from them
- shared_numbers: a picture whose pixels share random numbers, and its error
- film_state: state of a film in addition to its mean, in channels of a file
- particle_film: a picture as the sum of two films, in channels of a file
- partition: a render in parts
- recipe: what is needed to render a picture again, as JSON
- picture_files: reads channels and metadata of files
- denoised_channels: a denoised picture and its error, in channels of a file
- layer_sums: weighted layers, summed over two halves of the observations
- image: a picture and its files: EXR, PNG, NPY
- differences: differences of two recipes, in words
- moments: means and variances of disjoint samples, combined
- film_moments: moments of each film of a picture
- halves: first samples of a picture, and the rest of them
- merge: merges the parts of a render
- resume: whether a picture can be rendered on
- sources: finds the SCENE of a command: a file, a name, a picture
"""
