"""The time of each sample while the shutter is open, and the scene at that time.

All pixels of a sample see the scene at one time (Haeberli and Akeley 1990, "The accumulation
buffer"), so whatever an animation changes is blurred, and the kernel knows no time. The times of a
block of samples are spread evenly over the open shutter, and those of different blocks are
independent: then errors are estimated as for a still. Without blocks, errors of neighbouring pixels
would vary together more than `glrt compare` expects.
"""

from dataclasses import replace
from functools import lru_cache

from glrt.core.errors import UsageError
from glrt.plan.combinations import check_render
from glrt.plan.facts import SceneFacts
from glrt.plan.plan import Layering, Plan, prepare
from glrt.scene.frames import with_phong_of
from glrt.scene.instancing import Apart, after_moves
from glrt.scene.scene import Scene
from glrt.settings import Settings

_MASK = 0xFFFFFFFF
_EYES = 8  # parts of the time for which the shutter is open, to see whether a camera moves
_CLOCK = 0x7A5C31E9  # keeps times apart from the random numbers of shaders


def pcg_hash(x: int) -> int:
    """Return the hash of shaders_glsl/sampling/hash.glsl, of a number below 2^32."""
    state = (x * 747796405 + 2891336453) & _MASK
    word = (((state >> ((state >> 28) + 4)) ^ state) * 277803737) & _MASK
    return (word >> 22) ^ word


def time_of(sample: int, settings: Settings) -> float:
    """Return when a sample is taken: a share, 0 to below 1, of the time with an open shutter.

    It depends on the number of the sample and on the seed alone. Samples of a block have one time
    in each of as many equal parts; the order of these parts is random, and so is a time within its
    part.
    """
    block, place = divmod(sample, settings.block)
    key = _key(settings.seed, block)
    jitter = _key(key, place) / (_MASK + 1)
    return (_order(key, settings.block)[place] + jitter) / settings.block


def _key(seed: int, number: int) -> int:
    return pcg_hash(pcg_hash(seed ^ _CLOCK) + number & _MASK)


@lru_cache
def _order(key: int, size: int) -> tuple[int, ...]:
    """Return the numbers below `size` in a random order (Fisher and Yates)."""
    order = list(range(size))
    for last in range(size - 1, 0, -1):
        other = pcg_hash(key + last & _MASK) * (last + 1) >> 32
        order[last], order[other] = order[other], order[last]
    return tuple(order)


class Shutter:
    """The scene that each sample sees: always the same, or what moves while the shutter is open."""

    def __init__(
        self, scene: Scene, settings: Settings, opens: bool, apart: Apart = "repeated"
    ) -> None:
        """Begin before the first sample; unless it `opens`, the scene stays as it is."""
        self.opens, self.is_open = opens, opens and scene.is_blurred
        self._scene, self._settings, self._apart = scene, settings, apart
        self._sample: int | None = None  # the one that was planned last

    def after(self, scene: Scene, settings: Settings) -> "Shutter":
        """The shutter after an edit."""
        return Shutter(scene, settings, self.opens, self._apart)

    def check(self, layering: Layering, is_part: bool, is_fragment: bool) -> None:
        """Raise UsageError for options that a renderer cannot combine."""
        facts = SceneFacts(self._scene, self._apart)
        check_render(facts, self._settings, layering, is_part, is_fragment, self.is_open)
        if self.is_open and "position" in self._settings.aov and len(set(self._eyes())) > 1:
            raise UsageError(
                "the AOV position and a camera that moves while the shutter is open do not go "
                "together: positions are gathered relative to the camera. Leave position out of "
                "--aov, or close the shutter by `shutter = 0`."
            )

    def plan(self, layering: Layering, first_sample: int, before: Plan | None = None) -> Plan:
        """The plan to begin with, after `before` if it follows an edit.

        Raises `SceneError` if a curve leaves the range of its value.
        """
        seen = self._seen(first_sample)
        if before and not self.opens:
            return before.followed_by(*seen, layering, first_sample)
        plan = prepare(*seen, layering, first_sample, self._own_trees())
        return replace(plan, is_blurred=self.is_open)

    def next_plan(self, sample: int, now: Plan) -> Plan | None:
        """The plan for a sample; None if it is that of the sample before. Errors as of `plan`."""
        if not self.is_open or sample == self._sample:
            return None
        plan = prepare(*self._seen(sample), now.layering, now.first_sample, now.apart)
        return replace(plan, is_blurred=True)

    def relit(self, plan: Plan, layering: Layering, before: "Shutter") -> Plan | None:
        """The plan with weights that show a change since `before`; None if it must be traced."""
        if not (self.is_open or before.is_open):
            return plan.relit(self._scene, self._settings, layering)
        is_same = self._scene == before._scene
        return plan.relit(plan.scene, self._settings, layering) if is_same else None

    def _seen(self, sample: int) -> tuple[Scene, Settings]:
        """The scene that a sample sees, and its settings."""
        self._sample = sample
        if not self.is_open:
            return self._scene, self._settings
        still = self._scene.in_shutter(time_of(sample, self._settings))
        return still, with_phong_of(still, self._scene.moved, self._settings)

    def _eyes(self) -> list[tuple[float, ...]]:
        """Where the camera is at some of the times."""
        shares = (number / _EYES for number in range(_EYES + 1))
        return [tuple(self._scene.in_shutter(share).camera.position) for share in shares]

    def _own_trees(self) -> Apart:
        """Which meshes have a BVH of their own: large ones, too, if one moves."""
        if not self.is_open:
            return self._apart
        first, last = (self._scene.in_shutter(share).meshes for share in (0.0, 1.0))
        return "large" if after_moves("moved", first, last) == "large" else self._apart
