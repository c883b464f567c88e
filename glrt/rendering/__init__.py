"""Render a scene with settings: samples on a film.

Modules, each importing only what stands above it:

- passes: passes over the pixels of a picture, as values
- pipelines: compute or fragment pipeline
- plan_shaders: the shaders of a plan, without a driver
- shader_functions: calls of shader functions with a scene
- schedule: work per dispatch
- device_scene: a scene in driver memory, and its kernel source
- kernel_switch: switches between a generic and a baked kernel
- pass_film: film of a pass
- film: running mean and variance in textures
- aov_places: AOVs read back from films
- aov_tracer: gathers AOVs
- particle_tracer: gathers light of particles
- probe_tracer: gathers light of probes
- probe_supply: probes of the next samples
- raster: first surfaces by rasterisation
- screen: film, AOVs and probes drawn for the screen
- tracer: adds samples to a film
- adaptive_tracer: adds samples where the noise is
- paths: single paths, recorded and replayed
- layer_weights: weighted sum of the layers of a film
- progress: read-only properties of a renderer
- first_half: the first half of a render, for a denoiser
- shutter: the scene of each sample while the shutter is open
- renderer: the renderer: a scene and settings to samples
- history: samples of earlier views while the camera moves
- stopping: renders up to a limit of samples, time or error
- render_parts: renders a merged picture again
"""
