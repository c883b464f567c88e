"""Explanations of what a control changes in the light transport, with the equation.

L is radiance, f the reflectance of a surface (its BSDF), p a density, c the cosine at a surface.
"""

from glrt.settings import Effect
from glrt.view.controls import Control

EXPLANATIONS: dict[str, str] = {
    "method": (
        "All of these estimate L = Le + integral of f L' c over directions, by samples weighted "
        "f L' c / p. naive draws directions alone; nee draws points on lamps too, and counts lamps "
        "by these alone; mis weighs both ways by p^2 / (p^2 + q^2), where q is the density of the "
        "other one. phong, blinn, whitted and cook are models from before path tracing: they leave "
        "light out. ddgi takes light that has come over several surfaces from a grid of probes, "
        "which blurs it; gather does so one matte surface later, and resampled keeps one of the "
        "points that light the first matte surface. hybrid finds the first surface by "
        "rasterisation, and traces the effects that are chosen below; with all of them it is ddgi. "
        "march crosses smoke in steps of a fixed length, and sees nothing that is finer."
    ),
    "march_step": (
        "A ray through a grid sees the density m in the middle of each step s alone: the share "
        "exp(-m s) of the light goes on. The error falls with s^2 where density is smooth, and no "
        "number of samples shows it; mis has none."
    ),
    "sampler": (
        "Where the random numbers of a sample come from. independent: noise falls as 1 / sqrt(N). "
        "sobol: the samples of a pixel complete each other (scrambled Sobol' points), 16 at a "
        "time, so that it falls faster where light is smooth; sobol64, sobol256 and sobol1024: so "
        "many at a time. The mean is the same."
    ),
    "roulette": (
        "A path whose throughput is low ends with a chance of 1 - q, and one that goes on counts "
        "1 / q times: q L / q = L, so the mean stays. Paths take less time, and a little more "
        "noise."
    ),
    "probes": (
        "N x N x N points hold the light that arrives there, by direction. A surface is lit by the "
        "eight around it, E = sum(w E) / sum(w), by nearness and by whether they see it. 16 "
        "samples share a set of probes, which is warmed up first."
    ),
    "per_update": (
        "While edits follow one another, a picture updates this share s of the probes, in turn. An "
        "update takes s of the rays, and light lags 1 / s times as long. At rest, all probes are "
        "warmed up."
    ),
    "reuse": (
        "One of the points y_i is kept, with a chance of w_i / sum(w), where w_i = m_i P(y_i) / "
        "p(y_i). It counts L(y) sum(w) / P(y), so the mean stays. P is the light that y would "
        "bring. Points that other samples kept are candidates too: a sample has less noise, but "
        "samples and pixels share it."
    ),
    "unbiased": (
        "Two pixels with the targets P and P' may both find a point y: it then counts m = P(y) / "
        "(P(y) + P'(y)). A point that the other pixel cannot see counts whole; a visibility ray "
        "decides that. Without these rays the picture is too dark where points are hidden from "
        "some pixels."
    ),
    "caustics": (
        "on: also traces particles from the lamps, linked to the camera at surfaces that are not "
        "smooth. Each way to find light is weighed by p^2 / (p^2 + q^2 + r^2), so the mean stays; "
        "light that glass or mirrors focus has far less noise."
    ),
    "bounces": (
        "The largest number of scattering events B on a path; light that needs more is left out. "
        "In a closed room that shines with Le everywhere and has the albedo a, a picture shows "
        "Le (1 - a^(B+1)) / (1 - a) instead of Le / (1 - a)."
    ),
    "ambient": (
        "The radiance that a white surface has everywhere, I_a: it stands for all indirect light, "
        "and is the same in each corner. A surface of colour C sends I_a C."
    ),
    "diffuse": (
        "The share k_d of its colour that a surface reflects evenly: a lamp of irradiance E adds "
        "k_d C E (N.L) / pi, N.L the cosine between normal and lamp."
    ),
    "specular": (
        "The strength k_s of highlights: a lamp adds k_s E (N.H)^n / pi, H halfway between lamp "
        "and eye (blinn), or k_s E (R.V)^n / pi, R the mirrored direction (phong). Above 1 - k_d "
        "a surface may send more light than it gets."
    ),
    "exponent": (
        "The sharpness n of highlights: they are as wide as cos^n is. N.H falls with half the "
        "angle of R.V, so phong needs a quarter of the exponent of blinn for the same width."
    ),
    "intensity": (
        "Light adds up: a picture is the sum of those of its light groups, L = sum of w L(group). "
        "So the film keeps each group apart, and another intensity w is another weight, not "
        "another render."
    ),
    "emission": (
        "The radiance Le of each point of the lamp, in all directions. As light is linear in it, "
        "another colour is a factor of what the film keeps of this lamp."
    ),
    "samples": (
        "A pixel is the mean of N samples. Its standard error is s / sqrt(n), s the spread of n "
        "observations; half of the noise takes four times the samples."
    ),
    "exposure": "The display shows tone(2^EV L): a step of 1 EV doubles the light. Files keep L.",
    "roughness": (
        "The spread of microfacets: alpha = roughness^2 in the distribution of Trowbridge and "
        "Reitz (GGX). 0 is a mirror."
    ),
    "ior": (
        "The index of refraction n, inside over outside: sin(t) = sin(i) / n. At right angles "
        "((n - 1) / (n + 1))^2 of the light is reflected."
    ),
}


def explanation_of(control: Control) -> str:
    """Return the explanation for a control's name or the last word of its label; "" for none."""
    return EXPLANATIONS.get(control.name) or EXPLANATIONS.get(control.label.rpartition(" ")[2], "")


# Switches of method hybrid, by the names of its effects.
EFFECT_TEXTS: dict[Effect, str] = {
    "shadows": "a ray to each sampled point of a lamp: what it meets hides the lamp",
    "reflections": "rays that metal, glass and principled surfaces reflect; without them such "
    "surfaces show the highlights of lamps alone",
    "refractions": "rays through glass; without them glass shows nothing that is behind it",
    "ambient_occlusion": "a ray towards the background, which others may hide; without it the "
    "whole background lights each surface",
    "gi": "indirect light of matte surfaces, from a grid of probes as in method ddgi",
}
