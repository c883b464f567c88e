"""Features that this machine lacks, and what to install for them."""

from importlib.util import find_spec

from glrt.plan.combinations import MEANINGS, Way

# Purpose of each extra of the package, and the modules that it installs.
EXTRAS = {
    "view": ("the window", ("imgui_bundle", "glfw")),
    "chart": ("charts and stress tests", ("matplotlib",)),
    "flip": ("FLIP beside the error in charts", ("flip_evaluator",)),
}


def lacking(has_compute: bool) -> list[str]:
    """Return a line for each missing feature; `has_compute`: whether compute shaders work."""
    missing = [
        f"{purpose}: pip install 'glrt[{extra}]'"
        for extra, (purpose, modules) in EXTRAS.items()
        if not all(map(find_spec, modules))
    ]
    if not has_compute:
        layers = f"{Way.LAYERS} ({MEANINGS[Way.LAYERS]})"
        missing.append(f"{layers}: needs compute shaders, OpenGL 4.3")
    return missing
