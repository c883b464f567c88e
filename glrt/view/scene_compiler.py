"""Compile the kernel of a scene, its meshes included, in another process.

The driver keeps what it compiles, so that the window finds it and does not freeze. `python -m
glrt.view.scene_compiler` reads from its input what to compile, pickled.
"""

import pickle
import subprocess
import sys
from collections.abc import Callable
from tempfile import TemporaryFile

from glrt.packing.scene_tree import SceneTree
from glrt.plan.plan import Layering, prepare
from glrt.rendering.passes import RADIANCE, SURFACES
from glrt.rendering.pipelines import KernelOptions
from glrt.rendering.plan_shaders import shaders_of
from glrt.rendering.renderer import Renderer
from glrt.scene.scene import Scene
from glrt.settings import Cost, Settings
from glrt.view.kernel_notes import Driver, Note
from glrt.view.state.compile_ahead import cropped, same_driver
from glrt.view.state.moving_picture import MovingPicture

PAUSE = 0.1  # seconds between two calls of `goes_on`
_COMMAND = [sys.executable, "-m", "glrt.view.scene_compiler"]

Part = tuple[Scene, Settings, Layering, Driver]


def note_on(part: Part, tree: SceneTree | None) -> Note:
    """Return the note on the kernels of a part; `tree` is the BVH of its scene.

    Raises GlrtError where a renderer of the part does.
    """
    scene, settings, layering, driver = part
    plan = prepare(scene, settings, layering, apart="moved")
    options = KernelOptions(driver.pipeline, "generic")
    # The window finds both texts assembled, in the frame that takes the kernels.
    shaders = shaders_of(plan, tree, options, driver.uniform_bytes, (RADIANCE, SURFACES))
    return Note(shaders, driver, settings.aov)


def compile_for(part: Part, goes_on: Callable[[], object]) -> bool:
    """Compile the kernel of a part; return whether that worked.

    `goes_on` is called now and then; what it raises ends the process.
    """
    with TemporaryFile() as given:
        try:
            pickle.dump(part, given)
        except (pickle.PicklingError, TypeError, AttributeError):  # as of a file's animations
            return False
        given.seek(0)
        nowhere = subprocess.DEVNULL
        with subprocess.Popen(_COMMAND, stdin=given, stdout=nowhere, stderr=nowhere) as process:
            try:
                while process.poll() is None:
                    goes_on()
                    try:
                        process.wait(PAUSE)
                    except subprocess.TimeoutExpired:
                        continue
            except BaseException:
                process.kill()
                raise
            return process.returncode == 0


def compile_part(part: Part) -> None:
    """Compile the kernels of a part, and render: drivers compile at the first dispatch.

    Raises ContextError if the driver of the window cannot be opened in this process.
    """
    scene, settings, layering, driver = part
    context, pipeline = same_driver(driver.name, driver.pipeline), driver.pipeline
    small = cropped(settings)
    renderer = Renderer(scene, small, context, pipeline=pipeline, layering=layering, apart="moved")
    renderer.render(1)
    history = MovingPicture(context.gl)
    history.use(driver.way)
    history.arrive(renderer, Cost.RECOMPILE)
    history.prepare(renderer, renderer.plan.weights)


if __name__ == "__main__":
    compile_part(pickle.load(sys.stdin.buffer))
