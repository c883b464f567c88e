"""Sessions without a window: a settable clock, frames, rests, and processes that are played."""

from collections.abc import Callable
from typing import Any

from glrt.rendering.pipelines import Fast
from glrt.rendering.renderer import Renderer
from glrt.scene.scene import Scene
from glrt.view.controls import replaced
from glrt.view.state.idle_kernel import PAUSES
from glrt.view.state.preview_size import STILL
from glrt.view.state.session import ANNOUNCED, Session

Opening = Callable[..., Session]


class Clock:
    """A clock that a test sets: each reading takes a step of time."""

    def __init__(self) -> None:
        self.now, self.step = 100.0, 0.001

    def __call__(self) -> float:
        self.now += self.step
        return self.now


class Played:
    """A process that compiles ahead, with a given end."""

    def __init__(self, succeeded: bool) -> None:
        self.is_over, self.is_ended = True, False
        self.succeeded = succeeded

    def end(self) -> None:
        self.is_ended = True


class Stage:
    """Starts played processes: each has the next of the ends, the last end for ever."""

    def __init__(self, *ends: bool) -> None:
        self.ends = list(ends) or [True]
        self.played: list[Played] = []
        self.is_over = True

    def __call__(self, _: Renderer, tier: Fast) -> Any:
        end = self.ends.pop(0) if len(self.ends) > 1 else self.ends[0]
        self.played.append(Played(end))
        self.played[-1].is_over = self.is_over
        return self.played[-1]


def start(session: Session) -> None:
    for _ in range(ANNOUNCED + 1):
        session.advance(0.01)


def frames(session: Session, count: int) -> None:
    for _ in range(count):
        session.advance(1e-3, count=1)


def rested(session: Session, clock: Clock) -> bool:
    """Let a pause pass; whether the fastest kernel then has its turn."""
    frames(session, 1)
    clock.now += STILL
    frames(session, 1)  # at full size again, if the camera has moved
    for pause in PAUSES.values():
        clock.now += pause
        frames(session, 3)
    assert session.renderer
    return session.renderer.is_baked


def walked(scene: Scene) -> Scene:
    return replaced(scene, camera=replaced(scene.camera, position=(0.2, 0.1, 2.5)))
