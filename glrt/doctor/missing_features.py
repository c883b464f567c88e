"""What glrt could do, but not on this machine, and what would bring it."""

from importlib.util import find_spec

from glrt.plan.combinations import MEANINGS, Way

# What an extra of the package is for, and the modules that it brings.
EXTRAS = {
    "view": ("the window", ("imgui_bundle", "glfw")),
    "chart": ("charts and stress tests", ("matplotlib",)),
    "flip": ("FLIP beside the error in charts", ("flip_evaluator",)),
}


def lacking(has_compute: bool) -> list[str]:
    """One line for each thing that is not there; `has_compute`: whether compute shaders work."""
    missing = [
        f"{purpose}: pip install 'glrt[{extra}]'"
        for extra, (purpose, modules) in EXTRAS.items()
        if not all(map(find_spec, modules))
    ]
    if not has_compute:
        layers = f"{Way.LAYERS} ({MEANINGS[Way.LAYERS]})"
        missing.append(f"{layers}: needs compute shaders, OpenGL 4.3")
    return missing
