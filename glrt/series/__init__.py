"""Series of pictures: animations, turntables and sweeps, as files of frames and as films.

Modules, each importing only what stands above it:

- sweeps: values from one number to another
- motion: how much of the shapes moves, and the kernel that pays then
- series: the frames of a series, as scenes and settings
- outputs: files of the frames and of the film
- kept_frames: frames that were rendered before
- rendering: renders the frames that are missing
- lock: keeps two films out of one folder
- sheet: frames side by side in one picture
- containers: frames as a WebP, GIF or MP4 file
- film: a film: its frames, and the file made of them
"""
