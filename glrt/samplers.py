"""How each sampler divides the samples of a pixel into sequences, blocks and observations."""

from dataclasses import dataclass

NET = 8  # scrambles of sampler net: that of shaders_glsl/film/net.glsl
GROUPS = 16  # of sampler shared, whose blocks take turns


@dataclass(frozen=True)
class Division:
    """The samples of a pixel by one sampler."""

    points: int  # successive samples that complete each other
    scrambles: int = 0  # groups of samples whose means the film keeps
    is_shared: bool = False  # whether pixels share numbers, and are averaged with neighbours

    @property
    def block(self) -> int:
        """Number of samples in a block: renders in parts are cut between blocks."""
        return self.points * self.scrambles if self.is_shared else self.points

    @property
    def least_known(self) -> int:
        """Samples from which an error is known: two observations, or one block of all groups."""
        if self.is_shared:
            return self.block
        return 2 if self.scrambles else 2 * self.block

    def observations(self, samples: int) -> int:
        """Number of complete observations of `samples` per pixel."""
        if self.is_shared:  # pairs of groups
            return min(samples // (2 * self.points), self.scrambles // 2)
        return min(samples, self.scrambles) if self.scrambles else samples // self.block


DIVISIONS = {
    "sobol": Division(16),
    "sobol64": Division(64),
    "net": Division(NET, NET),
    "shared": Division(16, GROUPS, is_shared=True),
    "independent": Division(1),
}
