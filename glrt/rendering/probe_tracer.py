"""Light probes on the driver: maps of distances, and of light for one set of probes at a time.

The places of probes and the distances that they see follow from the scene alone. Light comes in
sets: each observation of the picture has one, from a seed of its own, so that the picture's error
includes the noise of probes. A set depends on its number alone: it is warmed up from nothing, and
then does not change. During a series of edits, probes may continue from the picture before.
"""

import time
from contextlib import ExitStack
from dataclasses import dataclass, replace

import moderngl
import numpy as np

from glrt.gpu.context import Context
from glrt.gpu.program import Images, Resource
from glrt.gpu.programs import AnyKernel
from glrt.packing.probes import (
    DISTANCE_MAP,
    DISTANCES,
    IN_ROW,
    LIGHT,
    LIGHT_MAP,
    PUSHES,
    USE,
    Turn,
    all_of,
    even_directions,
    seeds,
    turn,
    update_block,
)
from glrt.plan.methods import METHODS
from glrt.plan.plan import Plan
from glrt.plan.probe_grid import Grid, updated_at_once
from glrt.plan.probe_weights import WEIGHTS
from glrt.rendering.device_scene import DeviceScene
from glrt.rendering.kernel_switch import ready
from glrt.rendering.passes import PROBE_DISTANCES, PROBE_LIGHT, PROBE_PLACES, PROBE_RAYS, RenderPass
from glrt.rendering.schedule import DispatchRange

RAYS = 64  # per probe and update
AVERAGED = 16  # updates at the end of a warm-up that are averaged
UPDATES = len(WEIGHTS) + AVERAGED
LOOKS = 24  # updates that find distances
PUSHED = 4  # times that probes are moved before that
GROUP = 64  # lanes of a work group
FOLLOWING = 1 << 30  # the set number of live probes: beyond that of any other set

_MAPS = {"probe_light": LIGHT_MAP, "probe_distances": DISTANCE_MAP, "probe_places": 1}
_TEXELS = {name: side * side for name, side in _MAPS.items()}
_PASSES = {  # by the name of their target
    "target_rays": PROBE_RAYS,
    "probe_light": PROBE_LIGHT,
    "probe_distances": PROBE_DISTANCES,
    "probe_places": PROBE_PLACES,
}


def kept_light(update: int) -> float:
    """The fraction of the irradiance map that an update keeps while a set warms up."""
    averaged = update - len(WEIGHTS)
    return 1 - WEIGHTS[update] if averaged < 0 else averaged / (averaged + 1)


class _Update:
    """Stands in for a film in a pass over probes: its images alone."""

    next_sample, samples = 0, 1

    def __init__(self, images: Images) -> None:
        self._images = images

    def images(self) -> Images:
        return self._images


@dataclass
class Seconds:
    """Time that probes have taken so far, in seconds."""

    look: float = 0.0  # to place probes and find the distances that they see
    update: float = 0.0  # to gather their light


class ProbeTracer:
    """Computes sets of light probes for a plan; each set has a number."""

    def __init__(
        self,
        context: Context,
        plan: Plan,
        scene: DeviceScene,
        before: "ProbeTracer | None" = None,
        follows: bool = False,
    ) -> None:
        """Allocate the maps and compile the kernels.

        With `follows`, take over the maps of `before` if they hold light for as many probes. Raises
        RenderError if the driver has no room.
        """
        assert scene.grid
        self._context, self._scene, self.grid = context, scene, scene.grid
        # The light of probes scatters once more on its way to the camera; with a gather, twice.
        shorter = max(plan.settings.bounces - 1 - METHODS[plan.settings.method].gathers, 0)
        settings = plan.settings.model_copy(update={"bounces": shorter})
        self._plan, self.is_used = replace(plan, settings=settings), shorter > 0
        self._sees, self._set, self._done = False, -1, 0
        self._turn = self._all = all_of(self.grid.probes)  # the probes of the next update
        self._place_in_order = 0
        self.seconds = Seconds()
        self._is_placed = self.goes_on = False  # goes_on: with the maps of other probes
        start = time.perf_counter()
        with ExitStack() as refused:
            if before and follows and before.is_lit and before.grid.counts == self.grid.counts:
                self._go_on(before)
            else:
                self.maps = {name: _map(context, self.grid, name, refused) for name in _MAPS}
            self._rays = _texture(context, (RAYS, self.grid.probes), refused)
            with context.checked("the probes"):
                block = update_block(even_directions(RAYS), LIGHT, self._all)
                self._block = context.gl.buffer(block)
            refused.callback(self._block.release)
            self._kernels: dict[str, AnyKernel] = {}
            for name, each in _PASSES.items():
                self._kernels[name] = self._compiled(name, each)
                refused.callback(context.programs.give_back, self._kernels[name])
            refused.pop_all()
        self.compile_seconds = time.perf_counter() - start

    @property
    def resources(self) -> dict[str, Resource]:
        """The maps by the names under which kernels read them."""
        return dict(self.maps)

    @property
    def is_lit(self) -> bool:
        """Whether the maps hold light of all bounces, from any set of probes."""
        return not self.is_used or self._done >= UPDATES

    def has_set(self, number: int) -> bool:
        """Whether the maps hold the set `number`, warmed up."""
        return not self.is_used or (self._set == number and self._done == UPDATES)

    def work_on(self, number: int, seconds: float) -> None:
        """Update the set `number` until it is warmed up, or for about `seconds`."""
        start = time.perf_counter()
        while not self.has_set(number) and time.perf_counter() - start < seconds:
            self.update(number)

    def update(self, number: int, kept: float | None = None) -> None:
        """Update a set once; `kept` is the share of its light to keep (None: as it warms up)."""
        if not self._sees:
            self._look()
        if self._set != number:
            self._set, self._done = number, 0
            _clear(self.maps["probe_light"])
        start, seed, done = time.perf_counter(), self._plan.settings.seed, self._done
        share = kept_light(done) if kept is None else kept
        turned = even_directions(RAYS) @ turn(seeds(seed, number, done)).T
        own_seed = int(seeds(seed, number)[3])
        self._block.write(update_block(turned, LIGHT, self._turn, done, own_seed, share))
        self._gather("probe_light")
        self._context.finish()
        self._scene.lost_any()  # rays that are lost are left out
        self._done += 1
        self.seconds.update += time.perf_counter() - start

    def follow(self, hysteresis: float) -> Turn:
        """Update light and distances of live probes once; they keep the fraction `hysteresis`.

        Returns the probes whose turn it was. Places of all are found again if objects, or the room
        of the camera, may have changed.
        """
        if not self._is_placed:
            self._place()
        length = updated_at_once(self._plan.scene, self.grid.probes)
        self._turn = updated = Turn(self.grid.probes, self._place_in_order, length)
        self._see(FOLLOWING, self._done, kept=hysteresis)
        self._set = FOLLOWING
        self.update(FOLLOWING, hysteresis)
        self._turn, self._place_in_order = self._all, updated.next
        return updated

    def count(self) -> tuple[float, float]:
        """Rays of the warm-up of one set, and rays that find places and distances, as counted.

        The kernel must be a Variant with COUNT_RAYS; the numbers of any other mean nothing.
        """
        self._look()
        once = (PUSHED + 1 + LOOKS) * self._counted()
        self.update(0)
        return UPDATES * self._counted() * self.is_used, once

    def _counted(self) -> float:
        """The sum of what the rays of the last update have counted."""
        rays = np.frombuffer(self._rays.read(), np.float32).reshape(-1, 4)
        return float(rays[:, 0].sum(dtype=float))

    def release(self, after: "ProbeTracer | None" = None) -> None:
        """Release all OpenGL resources, except maps that `after` has taken over."""
        self._block.release()
        self._rays.release()
        if not after or after.maps is not self.maps:
            for texture in self.maps.values():
                texture.release()
        for kernel in self._kernels.values():
            self._context.programs.give_back(kernel)

    def _go_on(self, before: "ProbeTracer") -> None:
        """Take over the maps of another scene's probes; nothing is written yet."""
        self.maps, self._sees = before.maps, before._sees
        self._is_placed = before._is_placed and _stand_alike(self, before)
        self._set, self._done, self.goes_on = FOLLOWING, before._done, True
        self._place_in_order = before._place_in_order

    def _look(self) -> None:
        """Move probes out of solids and find the distances they see: the same for every seed."""
        start = time.perf_counter()
        self._place()
        _clear(self.maps["probe_distances"])
        for step in range(LOOKS):
            self._see(step, kept=step / (step + 1))
        self._context.finish()
        self._sees = True
        self.seconds.look += time.perf_counter() - start

    def _place(self) -> None:
        """Move probes out of solids, and mark the useful ones."""
        _clear(self.maps["probe_places"])
        for step in range(PUSHED + 1):
            purpose = PUSHES if step < PUSHED else USE
            self._block.write(update_block(even_directions(RAYS), purpose, self._all))
            self._gather("probe_places")
        self._is_placed = True

    def _see(self, *numbers: int, kept: float) -> None:
        """Update the distances once; `numbers` seed the random rotation of the rays."""
        turned = even_directions(RAYS) @ turn(seeds(*numbers)).T
        self._block.write(update_block(turned, DISTANCES, self._turn, kept=kept))
        self._gather("probe_distances")

    def _gather(self, name: str) -> None:
        """Trace rays from the probes whose turn it is, and add their results to the map `name`."""
        self._run("target_rays", RAYS)
        self._run(name, _TEXELS[name])

    def _run(self, name: str, lanes: int) -> None:
        """Run the pass that writes `name`, with `lanes` invocations per probe."""
        part = DispatchRange(0, 0, -(-lanes * self._turn.length // GROUP))
        self._dispatch(name, self._kernels[name], part)

    def _dispatch(self, name: str, kernel: AnyKernel, part: DispatchRange) -> None:
        """Dispatch `part` of the pass that writes `name`."""
        writes_rays = name == "target_rays"
        images = {name: self._rays} if writes_rays else {"updated_map": self.maps[name]}
        maps = self.maps if writes_rays else {"probe_rays": self._rays}
        own: dict[str, Resource] = {"ProbeBlock": self._block, **maps}
        self._scene.dispatch(kernel, _Update(images), self._plan, part, 1, own)

    def _compiled(self, name: str, each: RenderPass) -> AnyKernel:
        """Compile a pass by a dispatch whose results are cleared before they are read."""

        def dispatch(kernel: AnyKernel, part: DispatchRange) -> None:
            self._dispatch(name, kernel, part)

        return ready(self._context, self._scene.shaders_of(each), dispatch)


def _stand_alike(tracer: ProbeTracer, other: ProbeTracer) -> bool:
    """Whether the probes of two tracers have the same places and the same use."""
    scene, before = tracer._plan.scene, other._plan.scene
    is_same_eye = scene.camera.position == before.camera.position
    is_same_grid = tracer.grid.places().tolist() == other.grid.places().tolist()
    return is_same_eye and is_same_grid and scene.objects == before.objects


def _map(context: Context, grid: Grid, name: str, refused: ExitStack) -> moderngl.Texture:
    rows, side = -(-grid.probes // IN_ROW), _MAPS[name]
    return _texture(context, (IN_ROW * side, rows * side), refused)


def _texture(context: Context, size: tuple[int, int], refused: ExitStack) -> moderngl.Texture:
    with context.checked("the probes"):
        texture = context.gl.texture(size, 4, dtype="f4")
    refused.callback(texture.release)
    texture.filter = moderngl.NEAREST, moderngl.NEAREST
    return texture


def _clear(texture: moderngl.Texture) -> None:
    texture.write(np.zeros((texture.height, texture.width, 4), np.float32))
