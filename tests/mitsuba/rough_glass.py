"""glrt's rough glass as a plug-in of Mitsuba.

`roughdielectric` takes the shadowing of both directions as independent, and does not restore what
facets lose to each other. Its value is used, with the shadowing that glrt has, and the lost light
is added from glrt's albedos of facets. Sampling is of its own.
"""

from functools import cache
from typing import Any

import numpy as np

from glrt.scene.materials.facets import STEPS, FacetLoss

NAME = "glrt_rough_glass"
EVEN = 0.2  # the share of samples that are spread by the cosine over both sides


def words(alpha: float, ior: float, loss: FacetLoss | None) -> dict[str, Any]:
    """The plug-in as a dictionary."""
    if loss is None:
        none = np.ones(STEPS + 1)
        loss = FacetLoss((none, none), (1.0, 1.0), (0.0, 0.0))
    sides = zip("oi", loss.albedos, loss.means, loss.crossing, strict=True)
    numbers = {
        f"{side}{k}": float(value)
        for side, albedo, mean, crossing in sides
        for k, value in enumerate([*albedo, mean, crossing])
    }
    return {"type": NAME, "alpha": alpha, "ior": ior, **numbers}


@cache
def register(variant: str) -> None:
    """Make the plug-in known to Mitsuba, whose current variant this must be."""
    import drjit as dr  # type: ignore[import-not-found, unused-ignore]
    import mitsuba  # type: ignore[import-not-found, unused-ignore]

    mi: Any = mitsuba

    class RoughGlass(mi.BSDF):  # type: ignore[misc]
        """Parameters: `alpha`, `ior`; o0 to oN and i0 to iN, the rows of FacetLoss."""

        def __init__(self, properties: Any) -> None:
            mi.BSDF.__init__(self, properties)
            self.alpha, self.ior = properties["alpha"], properties["ior"]
            rows = [[properties[f"{side}{k}"] for k in range(STEPS + 3)] for side in "oi"]
            self.albedos = [mi.Float(row[:-2]) for row in rows]
            self.means, self.crossing = ([row[k] for row in rows] for k in (-2, -1))
            facets = {"distribution": "ggx", "alpha": self.alpha, "int_ior": self.ior}
            self.facets = mi.load_dict({"type": "roughdielectric", "ext_ior": 1.0, **facets})
            flags = mi.BSDFFlags.FrontSide | mi.BSDFFlags.BackSide | mi.BSDFFlags.NonSymmetric
            reflects, crosses = mi.BSDFFlags.GlossyReflection, mi.BSDFFlags.GlossyTransmission
            self.m_components = [reflects | flags, crosses | flags]
            self.m_flags = reflects | crosses | flags

        def sample(self, context: Any, si: Any, choice: Any, u: Any, active: Any) -> Any:
            found, _ = self.facets.sample(
                context, si, dr.minimum(choice / (1 - EVEN), 1), u, active
            )
            even = mi.warp.square_to_cosine_hemisphere(u)
            even.z *= dr.select(choice > 1 - EVEN / 2, -1, 1)
            is_even = choice >= 1 - EVEN
            wo = dr.select(is_even, even, found.wo)
            active = active & (is_even | (found.pdf > 0)) & (wo.z != 0)
            value, pdf = self.eval_pdf(context, si, wo, active)
            crosses = si.wi.z * wo.z < 0
            sample = dr.zeros(mi.BSDFSample3f)
            sample.wo, sample.pdf = wo, pdf
            sample.eta = dr.select(crosses, dr.select(si.wi.z > 0, self.ior, 1 / self.ior), 1)
            sample.sampled_component = dr.select(crosses, mi.UInt32(1), mi.UInt32(0))
            sample.sampled_type = dr.select(
                crosses,
                mi.UInt32(+mi.BSDFFlags.GlossyTransmission),
                mi.UInt32(+mi.BSDFFlags.GlossyReflection),
            )
            weight = dr.select(active & (pdf > 0), value / pdf, mi.Color3f(0))
            return sample, weight

        def eval(self, context: Any, si: Any, wo: Any, active: Any) -> Any:
            return self.eval_pdf(context, si, wo, active)[0]

        def pdf(self, context: Any, si: Any, wo: Any, active: Any) -> Any:
            return self.eval_pdf(context, si, wo, active)[1]

        def eval_pdf(self, context: Any, si: Any, wo: Any, active: Any) -> Any:
            active = active & (si.wi.z != 0) & (wo.z != 0)
            value = self.facets.eval(context, si, wo, active) * self.shadow(si.wi, wo)
            value += mi.Color3f(self.lost(si.wi, wo))
            density = (1 - EVEN) * self.facets.pdf(context, si, wo, active)
            density += EVEN / 2 * dr.abs(wo.z) / dr.pi
            return dr.select(active, value, mi.Color3f(0)), dr.select(active, density, 0)

        def shadow(self, wi: Any, wo: Any) -> Any:
            """G2 / (G1 G1') with G2 = 1 / (1 + L + L')."""
            eta = dr.select(wi.z > 0, self.ior, 1 / self.ior)
            half = dr.normalize(wi + wo * dr.select(wi.z * wo.z < 0, eta, 1))
            half = dr.select(half.z < 0, -half, half)
            normals = mi.MicrofacetDistribution(mi.MicrofacetType.GGX, self.alpha, True)
            a, b = normals.smith_g1(wi, half), normals.smith_g1(wo, half)
            return dr.select((a > 0) & (b > 0), 1 / (a + b - a * b), 0)

        def lost(self, wi: Any, wo: Any) -> Any:
            """Kulla and Conty's lobe, with the scale of radiance that crosses."""
            outside, crosses = wi.z > 0, wi.z * wo.z < 0
            crossing = dr.select(outside, self.crossing[0], self.crossing[1])
            share = dr.select(crosses, crossing, 1 - crossing)
            mean = dr.select(wo.z > 0, self.means[0], self.means[1])
            both = (1 - self.albedo(wi.z)) * (1 - self.albedo(wo.z)) / mean
            eta = dr.select(outside, 1 / self.ior, self.ior)
            return share * both * dr.abs(wo.z) / dr.pi * dr.select(crosses, eta * eta, 1)

        def albedo(self, cosine: Any) -> Any:
            place = dr.sqrt(dr.minimum(dr.abs(cosine), 1)) * STEPS
            step = dr.minimum(mi.UInt32(place), STEPS - 1)
            found = []
            for table in self.albedos:
                low, high = (dr.gather(mi.Float, table, step + k) for k in (0, 1))
                found.append(low + (place - mi.Float(step)) * (high - low))
            return dr.select(cosine > 0, *found)

        def to_string(self) -> str:
            return f"RoughGlass[alpha = {self.alpha}]"

    mi.register_bsdf(NAME, RoughGlass)
