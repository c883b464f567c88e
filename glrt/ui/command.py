"""`glrt view`: the window, or what to do where there can be none."""

import argparse

from glrt.errors import ContextError, UsageError
from glrt.library import load_recipe
from glrt.scene import with_lights
from glrt.settings import settings_for
from glrt.signals import handled, leave_at_once

EXTRA = ("imgui_bundle", "glfw")  # what `pip install 'glrt[view]'` brings


def view(arguments: argparse.Namespace, given: dict[str, object]) -> int:
    """Show the window until it is closed; `given` are the settings of the command line."""
    scene, recipe = load_recipe(arguments.scene)
    settings = settings_for(recipe or scene.render, **given)
    scene = with_lights(scene, dict(arguments.lights))
    try:
        with handled(leave_at_once):
            from glrt.ui.window import Window
    except ModuleNotFoundError as error:
        if error.name not in EXTRA:
            raise
        raise UsageError(
            f"the window needs the Python package {error.name}: type `pip install 'glrt[view]'`, "
            "or in a checkout `make view`. `glrt render` needs no window."
        ) from None
    except ImportError as error:  # a compiled package does not find a library of the system
        raise ContextError(
            f"no window can be opened: {error}. On Debian or Ubuntu install libgl1 and libx11-6. "
            "`glrt render` renders without a window."
        ) from None
    return Window(arguments.scene, scene, settings, arguments.pipeline).run()
