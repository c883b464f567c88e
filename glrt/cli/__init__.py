"""The commands, a module each.

Modules, each importing only what stands above it:

- options: what command lines share
- request: scene, settings and limits of a command line
- autosave: files saved now and then
- warnings: warnings about a finished picture
- render_report: report of a finished render
- caustics: whether a render has particles, where the command line leaves it open
- progress: the progress bar
- render: `glrt render`
- view: `glrt view`
- merge: `glrt merge`
- compare: `glrt compare`
- scenes: `glrt scenes`
- inspect: `glrt inspect`
- paths: `glrt paths`
- chart: `glrt chart`
- stress: `glrt stress`
- doctor: `glrt doctor`
- importing: `glrt import`
- schema: `glrt schema`
- commands: the table of commands
- main: how the command starts and ends
"""
