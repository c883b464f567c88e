"""`glrt view`: open the window, or say what is missing for it."""

import argparse

from glrt.cli.options import (
    SCENE,
    add_files,
    add_pipeline,
    add_settings,
    file_rules,
    settings_given,
)
from glrt.core.errors import ContextError, UsageError
from glrt.core.install import install
from glrt.denoise.filters import with_filter
from glrt.image.sources import STRICT, load_recipe
from glrt.process.command import loading
from glrt.scene.scene import Scene, with_lights
from glrt.settings import RenderSettings, Settings, settings_for
from glrt.view.opening import Later, is_large

DESCRIPTION = (
    "Show a scene in a window and change all its settings live. Closing the window saves only its "
    "preferences; its buttons save pictures and scenes. Unsaved edits of a window that is killed "
    "are offered at the next start with the same scene."
)
EPILOG = (
    "Exit codes: 0 closed, 2 wrong usage or scene, 3 no window, no usable OpenGL or a lost "
    "display, 129, 130 and 143 interrupted."
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command to its parser."""
    parser.add_argument(
        "scene",
        metavar="SCENE",
        nargs="?",
        help=f"{SCENE}; without one, the window shows scenes and recent files to choose from",
    )
    add_settings(parser)
    add_pipeline(parser)
    add_files(parser)


FIRST = "cornell"  # the scene that settings without a scene are for
EXTRA = ("imgui_bundle", "glfw")  # modules that the extra `view` installs


def run(arguments: argparse.Namespace) -> int:
    """Show the window until it is closed; ContextError (exit code 3) if none can be opened."""
    given = settings_given(arguments)
    is_for_one = bool(given or arguments.lights)  # then a window without a scene shows FIRST
    source = arguments.scene or (FIRST if is_for_one else "")
    rules, lights = file_rules(arguments), dict(arguments.lights)

    def changed(scene: Scene, settings: RenderSettings) -> tuple[Scene, Settings]:
        return with_lights(scene, lights), with_filter(settings_for(settings, **given))

    later: Later | None = None
    if source and "denoise" not in given and is_large(source):
        later, source, rules = (source, rules, changed), "", STRICT
    scene, recipe = load_recipe(source or FIRST, rules)
    settings = settings_for(scene.render)
    if not later:
        scene, settings = changed(scene, recipe or scene.render)
    try:
        with loading():
            from glrt.view.window import Window
    except ModuleNotFoundError as error:
        if error.name not in EXTRA:
            raise
        raise UsageError(
            f"the window needs the Python package {error.name}: type `{install('view')}`, "
            "or in a checkout `make view`. `glrt render` needs no window."
        ) from None
    except ImportError as error:  # a compiled package does not find a library of the system
        raise ContextError(
            f"no window can be opened: {error}. On Debian or Ubuntu install libgl1 and libx11-6. "
            "`glrt render` renders without a window."
        ) from None
    return Window(source, scene, settings, arguments.pipeline, rules, later).run()
