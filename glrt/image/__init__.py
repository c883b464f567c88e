"""Pictures in files, with their recipe and the state of their film.

Modules, each importing only what stands above it:

- tonemap: from radiance to the colours of a screen
- aovs: AOVs of a picture, in channels of a file
- film_state: what a film holds beside its mean, in channels of a file
- particle_film: a picture as the sum of two films, in channels of a file
- partition: a render in parts
- recipe: what made a picture, as JSON
- picture_files: channels and metadata of files, read
- denoised_channels: a denoised picture and its error, in channels of a file
- layer_sums: layers under weights, over two halves of the observations
- image: a picture and its files: EXR, PNG, NPY
- differences: what differs between two recipes, in words
- moments: means and variances of disjoint samples, put together
- film_moments: what a picture has gathered on each of its films
- halves: the first samples of a picture, and the rest of them
- merge: parts put together
- resume: whether a picture can be rendered on
- sources: what SCENE means: a file, a name, a picture
"""
