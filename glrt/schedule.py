"""How many samples one dispatch may take: the driver's loop limit, and a time budget."""

from glrt.errors import SceneError
from glrt.scene import Scene
from glrt.settings import RenderSettings

BUDGET = 0.25  # seconds a dispatch: progress and interruption stay prompt


def iterations_per_sample(scene: Scene, settings: RenderSettings) -> int:
    """Rounds of all loops for one sample: each segment runs over the shapes, once or twice.

    A loop over the shapes of one kind takes a round more than there are shapes: the one in which
    it finds that there are no more.
    """
    rays = 1 if settings.method == "naive" else 2
    kinds = len({shape.shape for shape in scene.objects})
    return 1 + (settings.bounces + 1) * (1 + rays * (len(scene.objects) + kinds))


def most_samples(iterations: int, rounds: int | None) -> int:
    """How many samples fit into a dispatch of so many rounds; SceneError when not even one does.

    `rounds`: None for a driver that does not limit loops.
    """
    if rounds is None:
        return 1 << 10
    if iterations > rounds:
        raise SceneError(
            f"the scene is beyond this driver's loop limit: one sample takes up to "
            f"{iterations} rounds of its loops (shapes x bounces), and it stops silently after "
            f"{rounds}, with a wrong image. Use fewer objects, fewer bounces or a GPU."
        )
    return rounds // iterations


class Schedule:
    """Doubles the samples of a dispatch while they fit into the budget."""

    def __init__(self, most: int, budget: float = BUDGET) -> None:
        """`most`: samples that a dispatch may take; `budget`: seconds it should take."""
        self._most = most
        self._budget = budget
        self._count = 1

    def next_count(self, remaining: int) -> int:
        """How many samples the next dispatch takes."""
        return max(1, min(self._count, self._most, remaining))

    def record(self, count: int, seconds: float) -> None:
        """Learn from a dispatch."""
        fitting = int(count * self._budget / max(seconds, 1e-9))
        self._count = max(1, min(2 * count, fitting))
