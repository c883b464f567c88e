"""A scene in the driver's memory: its arrays, and the text of the kernels that read them."""

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from glrt.errors import RenderError
from glrt.gpu.context import Context
from glrt.gpu.glsl import Source
from glrt.gpu.program import FragmentKernel, Images, Kernel, Resource
from glrt.gpu.struct_arrays import BAKED, Tier, tier_for
from glrt.methods.features import has_tree, needs_of
from glrt.methods.light_layers import Plan
from glrt.rendering.pack import STRUCTS, pack_frame, pack_scene
from glrt.rendering.pipelines import Arrays, Resolved, scene_text, sources, upload
from glrt.rendering.schedule import Portion, stride_of
from glrt.scene.scene import Scene


class Way(NamedTuple):
    """How a scene is to reach the kernel; `parts` are texts that stand in for shader files."""

    pipeline: Resolved
    tier: Tier
    parts: Mapping[str, str]


class Uploaded:
    """What a kernel reads of a scene, beside the film."""

    def __init__(
        self, context: Context, plan: Plan, way: Way, before: "Uploaded | None" = None
    ) -> None:
        """Give the driver the scene of a plan; the tier is another if the scene is too large.

        The same scene as `before` is not packed again. RenderError if the driver has no room.
        """
        self._gl, self._way, self._scene = context.gl, way, plan.scene
        self._arrays: Arrays = _packed(plan.scene, before)
        self._counts = {name: len(rows) for name, rows in self._arrays.items()}
        self._constants = needs_of(plan.scene, plan.settings).constants() | plan.constants()
        self._has_tree = has_tree(plan.scene)  # without one none are lost
        self.tier = tier_for(self._arrays, way.tier)
        self._parts = self._parts_of(self.tier)
        self._resources: dict[str, Resource] = {}
        try:
            with context.checked("the scene"):
                self._upload()
        except RenderError:
            self.release()
            raise

    @property
    def shaders(self) -> list[Source]:
        """The kernel that reads this."""
        return self._shaders(self._parts)

    def baked(self) -> list[Source] | None:
        """A kernel that has the shapes as constants and reads the rest here; None where it is this.

        Or where there are too many shapes for that.
        """
        tier = tier_for(self._arrays, "baked")
        return None if tier == self.tier else self._shaders(self._parts_of(tier))

    def is_read_alike(self, other: "Uploaded") -> bool:
        """Whether the kernel of one scene does for the other."""
        return (self._constants, self._parts) == (other._constants, other._parts)

    def has_shapes_of(self, other: "Uploaded") -> bool:
        """Whether constants written for one scene do for the other: to the last bit."""
        return all(same_rows(self._arrays[name], other._arrays[name]) for name in BAKED)

    def dispatch(
        self,
        kernel: Kernel | FragmentKernel,
        images: Images,
        plan: Plan,
        first_sample: int,
        portion: Portion,
        tiles: int,
    ) -> None:
        """Let a kernel add a portion's samples, from `first_sample` on, of a picture of `tiles`."""
        numbers = first_sample, portion.samples, portion.first, stride_of(tiles)
        self._frame.write(pack_frame(plan.scene, plan.settings, self._counts, *numbers))
        kernel.bind(self._resources, images)
        kernel.run_tiles(portion.tiles)

    def lost_any(self) -> bool:
        """Whether a kernel has lost samples to the loop limit since this was last asked."""
        if not self._has_tree or not any(self._lost.read()):
            return False
        self._lost.clear()
        return True

    def release(self) -> None:
        """Free what the driver holds."""
        for resource in self._resources.values():
            resource.release()

    def _upload(self) -> None:
        self._frame = self._resources["FrameBlock"] = self._gl.buffer(
            reserve=STRUCTS["Frame"].itemsize
        )
        self._lost = self._resources["Lost"] = self._gl.buffer(bytes(4))
        self._resources |= upload(self._gl, self._way.pipeline, self._arrays, self.tier)

    def _parts_of(self, tier: Tier) -> dict[str, str]:
        """What the text of the kernel depends on, beside constants and files."""
        text = scene_text(self._gl, self._way.pipeline, self._arrays, tier)
        return {"blocks.glsl": text, **self._way.parts}

    def _shaders(self, parts: Mapping[str, str]) -> list[Source]:
        return sources(self._way.pipeline, self._constants, parts)


def _packed(scene: Scene, before: Uploaded | None) -> Arrays:
    """The arrays of a scene; what those from before hold of it is not computed again."""
    if before and before._scene == scene:
        return before._arrays
    is_elsewhere = before is not None and before._scene.objects == scene.objects
    return pack_scene(scene, before._arrays["Nodes"] if before and is_elsewhere else None)


def same_rows(left: np.ndarray[Any, Any], right: np.ndarray[Any, Any]) -> bool:
    """Whether two arrays hold the same bits."""
    return left.tobytes() == right.tobytes()
