"""The commands of glrt, one module each.

Modules, each importing only what stands above it:

- options: options that commands share
- sampler: choice of the sampler where the command line leaves it open
- request: scene, settings and limits of a command line
- autosave: files saved now and then
- reports: reports of pictures
- caustics: choice of particles where the command line leaves it open
- render: `glrt render`
- film_jobs: jobs of render farms
- film: `glrt film`
- view: `glrt view`
- merge: `glrt merge`
- compare: `glrt compare`
- scenes: `glrt scenes`
- simplify: `glrt inspect --simplify`
- inspect: `glrt inspect`
- paths: `glrt paths`
- moving_options: options of `glrt chart` for what moves
- chart: `glrt chart`
- export: `glrt export`
- stress: `glrt stress`
- doctor: `glrt doctor`
- importing: `glrt import`
- schema: `glrt schema`
- commands: the table of commands
- main: how the command starts and ends
"""
