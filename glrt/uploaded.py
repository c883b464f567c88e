"""A scene in the driver's memory: its arrays, and the text of the kernels that read them."""

from collections.abc import Mapping
from typing import Any

import moderngl
import numpy as np

from glrt.blocks import BAKED, Tier, tier_for
from glrt.kernel import FragmentKernel, Images, Kernel
from glrt.needs import has_tree, needs_of
from glrt.pack import STRUCTS, pack_frame, pack_scene
from glrt.pipelines import Resolved, scene_text, sources, upload
from glrt.relight import Plan
from glrt.schedule import Portion, stride_of
from glrt.shader import Source


class Uploaded:
    """What a kernel reads of a scene, beside the film."""

    def __init__(
        self,
        gl: moderngl.Context,
        plan: Plan,
        pipeline: Resolved,
        wanted: Tier,
        parts: Mapping[str, str],
    ) -> None:
        """Give the driver the scene of a plan; the tier is another if the scene is too large.

        `parts` are texts that stand in for shader files.
        """
        self._gl, self._pipeline, self._parts = gl, pipeline, parts
        self._arrays = pack_scene(plan.scene)
        self._counts = {name: len(rows) for name, rows in self._arrays.items()}
        self._constants = needs_of(plan.scene, plan.settings).constants() | plan.constants()
        self._has_tree = has_tree(plan.scene)  # without one none are lost
        self.tier = tier_for(self._arrays, wanted)
        self.shaders = self._shaders(self.tier)
        self._frame = gl.buffer(reserve=STRUCTS["Frame"].itemsize)
        self._lost = gl.buffer(bytes(4))
        self._resources = {
            **upload(gl, pipeline, self._arrays, self.tier),
            "FrameBlock": self._frame,
            "Lost": self._lost,
        }

    def baked(self) -> list[Source] | None:
        """A kernel that has the shapes as constants and reads the rest here; None where it is this.

        Or where there are too many shapes for that.
        """
        tier = tier_for(self._arrays, "baked")
        return None if tier == self.tier else self._shaders(tier)

    def is_read_alike(self, other: "Uploaded") -> bool:
        """Whether the kernel of one scene does for the other."""
        return texts(self.shaders) == texts(other.shaders)

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

    def _shaders(self, tier: Tier) -> list[Source]:
        text = scene_text(self._gl, self._pipeline, self._arrays, tier)
        return sources(self._pipeline, self._constants, {"blocks.glsl": text, **self._parts})


def texts(shaders: list[Source]) -> list[str]:
    """What the driver compiles."""
    return [shader.text for shader in shaders]


def same_rows(left: np.ndarray[Any, Any], right: np.ndarray[Any, Any]) -> bool:
    """Whether two arrays hold the same bits."""
    return left.tobytes() == right.tobytes()
