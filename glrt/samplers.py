"""How each sampler divides the samples of a pixel into blocks and observations."""

from dataclasses import dataclass

GROUPS = 16  # of sampler shared, whose blocks take turns


@dataclass(frozen=True)
class Division:
    """The samples of a pixel by one sampler."""

    points: int  # successive samples that complete each other
    groups: int = 0  # of shared numbers: pixels share them, and are averaged with neighbours

    @property
    def is_shared(self) -> bool:
        """Whether pixels share numbers, so that the film keeps the means of groups of samples."""
        return self.groups > 0

    @property
    def block(self) -> int:
        """Number of samples in a block: renders in parts are cut between blocks."""
        return self.points * max(self.groups, 1)

    @property
    def least_known(self) -> int:
        """Samples from which an error is known: two observations, or one block of all groups."""
        return self.block if self.is_shared else 2 * self.block

    def observations(self, samples: int) -> int:
        """Number of complete observations of `samples` per pixel: blocks, or pairs of groups."""
        if self.is_shared:
            return min(samples // (2 * self.points), self.groups // 2)
        return samples // self.block


DIVISIONS = {
    "sobol": Division(16),
    "sobol64": Division(64),
    "sobol256": Division(256),
    "sobol1024": Division(1024),
    "shared": Division(16, GROUPS),
    "independent": Division(1),
}
