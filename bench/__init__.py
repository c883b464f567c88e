"""Measurements of speed, memory and noise of glrt and of other renderers. Not part of the wheel.

Studies that are finished are in the history of the repository, up to commit f3b2481.

Programs, `python -m bench.NAME`; `--help` lists their options:

- against: whether this checkout is slower than another commit
- gpu: every route, pipeline and tier on this machine against the first; the test of a new GPU
- scenes: random scenes by seed, as files
- landscapes: the same with meshes and skies
- kernels: the speed of the kernel and of its variants
- efficiency: variance and time with one setting of a render changed at a time
- shape_counts: the speed-up by a tree over shapes, by their number
- mesh_sizes: speed and memory by the number of triangles
- roofline: the speed of the kernel relative to the peak of the machine
- memory: the memory of a render, by its uses
- load: frames a second and the load of the machine, as the thesis reports them
- rivals: time to an error of 2 %, against other renderers
- unseen: the lead over Mitsuba on scenes drawn from a hash of the program
- volumes_rivals: the same in fog, smoke and milk
- real_models: real models by glrt and by Mitsuba, compared
- doubt: how often the judgement on an estimated error is wrong, on new scenes
- denoised: what a denoiser gains, and whether it knows its error
- calibration: the estimated error of pictures against their true error
- error_ratios: the same where few samples find light, and in ordinary scenes
- false_alarms: the rates of false alarms and of detections of `glrt compare`
- picture_runs: how often a run of fifty picture tests alarms falsely
- choices: whether `--caustics auto` chooses the best
- films: whether a film takes longer than its stills
- clusters: the cost of a cluster, of its scheduler and of several workers
- foggy: samples of lamps along segments through fog
- terms: terms of light by several methods, and their cost
- effects: light and rays of each effect of method hybrid
- adaptive: the error of pictures whose pixels have counts of their own
- shared: what random numbers that pixels share gain, and the error that such pictures estimate
- steps: the bias of ray marching by the length of its steps
- probe_shares: cost and lag of live probes that are updated in turn
- window_tour: frame times of the window, driven by a script
- window_films: films of the window in README and docs
- window_times: time to the window, its picture, and full size after a drag
- drags: whether the picture in the window follows a drag
- redraw: how much clearer the picture is while the camera moves
- upsampling: upsampled against enlarged coarse pictures at equal work
- pictures: all pictures of docs
- stress_sheets: the charts of all stress cases, on three sheets
- gallery: every scene that comes with glrt, as pictures and a page of them
- thumbnails: every scene that comes with glrt, in one small picture for the window
- weekend: writes scenes/weekend.toml

They share:

- program: options, the description of the machine, and errors in one paragraph
- shader_edits: kernels with edited shader sources
- processes: processes that answer requests over pipes
- peer: renderers as such processes
- glrt_peer: glrt as one of them
- entries: glrt and other renderers as they take part in a contest
- turns: renderers that take turns, and whether that costs them speed
- against_side: one side of `against`, which may import a much older glrt
- gpu_way: one route, pipeline and tier, measured in a process of its own for `gpu`
- window_times_side: one window, measured in a process of its own for `window_times`
- sleeping: tasks that sleep, for `clusters`
- window_stops_side: the longest stop of each action in a window, in a process of its own
- load_side: frames of one scene, drawn in a process of its own for `load`
- checkouts: another commit in a temporary folder
- ratios: ratios of times from interleaved rounds, with intervals
- contest: one renderer against another, from many renders
- cold_start: time and memory of a process to its first picture
- sheets: renders with titles, in rows of one size
- contact_sheet: pictures of any size in rows, small enough for a front page
- composites: renders next to each other, for `pictures`
- screen_sheets: AOVs and probes as the window shows them, for `pictures`
- notebook_page: a live picture in JupyterLab, for `pictures`
- screens: virtual X servers
- truth: two renders of a scene that pictures are judged by
- fooling_scenes: random scenes whose estimated error is likely to be wrong
- dice: random numbers that are the same on every machine
- placing: random positions without overlaps
"""
