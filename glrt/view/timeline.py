"""The frame of the animation that is shown, and its playback."""

from glrt.core.errors import GlrtError
from glrt.scene.scene import Scene
from glrt.view.edits.keyframes import Keys, at_frame, last_frame
from glrt.view.state.session import Session


class Timeline:
    """Shows frames of a session's scene; they are no edits, and no steps of undo."""

    def __init__(self, session: Session) -> None:
        """Begin at frame 0, without playing."""
        self._session = session
        self.frame = 0
        self.is_playing = False
        self.is_wanted = False  # also for a scene without an animation
        self.chosen: Keys | None = None  # the value that gets keys
        self._since = 0.0

    @property
    def is_shown(self) -> bool:
        """Whether the window has the strip."""
        return self.is_wanted or self._session.scene.animation is not None

    def toggle(self) -> None:
        """Show the strip for a scene without an animation, or hide it."""
        self.is_wanted = not self.is_wanted

    def begin(self) -> None:
        """Begin again, for another scene."""
        self.frame, self.is_playing, self.chosen = 0, False, None

    def show(self, frame: int) -> None:
        """Show a frame; one that cannot be shown is reported, and ends the playback."""
        self.frame = max(0, min(frame, last_frame(self._session.scene)))
        try:
            self._session.show(at_frame(self._session.scene, self.frame))
        except GlrtError as error:
            self._session.problem, self.is_playing = str(error), False

    def play(self, now: float) -> None:
        """Play, from the start once the end is reached, or stop."""
        self.is_playing = not self.is_playing and self._session.scene.animation is not None
        self._since = now

    def follow(self, now: float) -> None:
        """Show the next frame when it is due, and the one before has a sample; call it often.

        Frames that are late are left out, so that the speed is right.
        """
        animation = self._session.scene.animation
        self.is_playing &= animation is not None
        if not self.is_playing or not animation or self._session.is_behind:
            return
        due = int((now - self._since) * animation.fps)
        if due and self._session.is_shown:
            self._since = now
            self.show((self.frame + due) % animation.count)

    def text(self, scene: Scene) -> str:
        """Return the time of the frame and of the end: "1.25 of 4 s"."""
        animation = scene.animation
        if not animation:
            return "no keys yet"
        end = animation.moment(animation.count - 1)
        return f"{animation.moment(self.frame):.2f} of {end:.4g} s"
