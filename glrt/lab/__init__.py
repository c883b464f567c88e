"""Sweeps of one parameter each, up to where common methods of path tracing fail.

Modules, each importing only what stands above it:

- noisy_scenes: scenes with little noise, with rare bright samples, with hardly any hits
- scenes: builders of small scenes
- sweep: the result of a sweep and its guarantee, and what cases run with
- rays: intersections from far away, at every scale, at grazing angles
- triangles: rays at edges, rays that leave, and triangles that are drawn
- lamps: small lamps, many lamps, a lamp below a ceiling
- spots: edges of cones, one spot among many
- glass: refraction and caustics
- dispersion: glass that parts colors
- particles: caustics of lamps, glasses, numbers of balls and cameras of any kind
- probes: light through thin walls, rooms that hardly absorb
- reuse: points of other pixels, where slats stand between
- denoising: the bias of a filter, what is thin, and fireflies
- volumes: light in volumes
- temporal: what is shown from frame to frame
- blur: the blur of what moves while the shutter is open
- sky: a sun of one pixel in an image of the sky
- rough_glass: the light that rough glass, plastic, films, cloth, paper and brushed metal keep
- textures: coordinates far away, bent normals, layers full of holes
- points: points of a sampler, in ever more dimensions and in any number
- sums: accumulation, random numbers, long paths
- samples: pixels that get samples by their noise, or share numbers with neighbours
- views: positions and fields of view of the camera
- truths: scenes of some cases whose radiance is known in closed form
- cases: all cases by name
- report: table, figures and charts
"""
