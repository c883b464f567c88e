"""A scene with its settings, and what both together ask of the kernel."""

from collections.abc import Sequence
from dataclasses import dataclass

from glrt.core.memo import computed_once
from glrt.plan.facts import SceneFacts
from glrt.plan.methods import METHODS, Traits, reuses_points, traits_of
from glrt.plan.particles import ParticleFacts
from glrt.scene.materials.kinds import glass_of
from glrt.scene.materials.metal import Metal
from glrt.scene.scene import Scene
from glrt.settings import Settings

MOST_APPROACHED = 8  # lamps that are weighed along every segment through a medium


@dataclass(frozen=True)
class Case:
    """A scene with its settings; features of the kernel follow from both."""

    facts: SceneFacts
    settings: Settings

    @property
    def scene(self) -> Scene:
        """The scene."""
        return self.facts.scene

    @property
    def traits(self) -> Traits:
        """Traits of the method."""
        return traits_of(self.settings)

    @property
    def particles(self) -> ParticleFacts:
        """Facts of the scene that particles need."""
        return self.facts.particles

    @computed_once
    def metals(self) -> Sequence[Metal]:
        """The metals of visible surfaces."""
        return [it for it in self.facts.materials.values() if isinstance(it, Metal)]

    @computed_once
    def is_lit(self) -> bool:
        """Whether the method uses lamps, and the scene has some that are sampled."""
        return self.traits.uses_lamps and self.facts.sampled_lamps > 0

    @computed_once
    def has_background(self) -> bool:
        """Whether light comes from the sky."""
        return any(map(any, self.scene.background_colors))

    @computed_once
    def has_image(self) -> bool:
        """Whether light comes from an image of the sky."""
        return has_image(self.scene)

    @computed_once
    def has_sun(self) -> bool:
        """Whether light comes from the sun."""
        return any(self.scene.sun_radiance)

    @computed_once
    def sends_particles(self) -> bool:
        """Whether particles are wanted, some light sends them, and the method weighs them."""
        particles = self.particles
        sends = self.is_lit or particles.sun_sends or particles.sky_sends
        return self.settings.caustics == "on" and sends and self.traits.weighs_particles

    @property
    def adapts(self) -> bool:
        """Whether pixels get samples in proportion to their noise."""
        return self.settings.adaptive == "on"

    @property
    def has_media(self) -> bool:
        """Whether the method follows light through media, and the scene has some."""
        return bool(self.facts.media.names) and not self.traits.model

    @property
    def has_grids(self) -> bool:
        """Whether the density of such a medium varies."""
        return self.has_media and bool(self.facts.media.grids)

    @property
    def has_ranks(self) -> bool:
        """Whether the method crosses volumes that overlap by priority."""
        return self.facts.media.is_ranked and self.traits.follows

    @property
    def has_transfers(self) -> bool:
        """Whether such a medium is a scientific volume, with a transfer function."""
        return self.has_media and bool(self.facts.media.transfers)

    @property
    def marches(self) -> bool:
        """Whether such a medium is crossed in steps of a fixed length."""
        return self.traits.marches and self.has_grids

    @property
    def samples_along_segments(self) -> bool:
        """Whether light of few lamps is sampled along segments through media of even density."""
        media = self.facts.media
        if not self.has_media or len(media.grids) == len(media.names):
            return False
        is_sampled = self.is_lit and self.traits.samples_lights
        return is_sampled and self.facts.sampled_lamps <= MOST_APPROACHED

    @property
    def types(self) -> frozenset[str]:
        """Types of materials that the kernel distinguishes; glass only if it is followed."""
        types = {it.type for it in self.facts.materials.values() if not glass_of(it)}
        is_solid = self.traits.follows and self.facts.solid_glasses
        return frozenset(types | ({"dielectric"} if is_solid else set()))

    @property
    def rasters(self) -> bool:
        """Whether first surfaces are rasterised: with a lens or shared places they are traced."""
        has_lens = self.scene.camera.defocus_angle > 0
        return self.traits.rasters and not has_lens and not self.facts.coincidence.pairs

    @property
    def aims(self) -> bool:
        """Whether some particles are aimed at what makes caustics."""
        return self.sends_particles and self.settings.aimed > 0

    @property
    def resamples(self) -> bool:
        """Whether light is resampled; a ray sees through holes at random, so not with holes."""
        return self.traits.resamples and not self.facts.lobes.holed

    @property
    def reuses(self) -> bool:
        """Whether points of other samples or pixels are reused."""
        return self.resamples and reuses_points(self.settings)

    @property
    def takes_turns(self) -> bool:
        """Whether only some of the live probes are updated at a time."""
        probes = self.scene.probes
        return self.traits.has_probes and probes is not None and probes.per_update < 1

    @property
    def own_phong(self) -> bool:
        """Whether constants of the scene replace those of materials in Phong's model."""
        phong = self.settings.phong
        return self.traits.has_constants and phong is not None and phong.is_given

    @property
    def model(self) -> int:
        """Number of the method's lighting model; 0 for path tracing.

        Without highlights, `blinn` is the same model as `phong`.
        """
        is_rough = any(metal.alpha > 0 for metal in self.metals) or self.own_phong
        is_phong = self.settings.method == "blinn" and not is_rough
        return METHODS["phong"].model if is_phong else self.traits.model


def has_image(scene: Scene) -> bool:
    """Return whether light comes from an image of the sky."""
    return any(map(any, scene.background_colors)) and scene.background.is_pictured
