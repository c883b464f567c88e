"""Bugs of links through single spheres: their ways, their spread, their shares, their weight."""

from tests.mutation.mutant import Mutant, edit

_LINKS = "integrators/sphere_links.glsl"
_CAMERA_LINKS = "integrators/camera_links.glsl"
_BESIDE = "integrators/path_beside_particles.glsl"
_SHADERS = "shaders/test_sphere_links.py"
_PICTURES = "rendering/test_particle_links.py"
_LIGHT = f"{_PICTURES}::test_links_change_the_noise_alone"

SPHERE_LINKS = [
    Mutant(
        "Fresnel's share is not in the density of a link",
        edit(
            _LINKS,
            "spread_of(arc, at) * chance_of(material, at, arc.chords);",
            "spread_of(arc, at);",
        ),
        _LIGHT,
    ),
    Mutant(
        "glass sends all light by each way",
        edit(_LINKS, "chords == 0 ? reflected : chords == 1 ? passed :", "chords < 2 ? 1.0 :"),
        f"{_SHADERS}::test_glass_sends_fresnel_s_share",
    ),
    Mutant(
        "the way that falls is missed",
        edit(_LINKS, "u < SIDE ? 1.0 : -1.0, u >= 0.5", "u < SIDE ? 1.0 : -1.0, false"),
        f"{_SHADERS}::test_branches_are_drawn_as_their_shares_say",
    ),
    Mutant(
        "a root is given up after three steps",
        edit(_LINKS, "const int ROUNDS = 12;", "const int ROUNDS = 3;"),
        f"{_SHADERS}::test_every_way_of_light_is_found",
    ),
    Mutant(
        "a branch is found that turns the other way",
        edit(_LINKS, "branch.sign * arc.sine", "-branch.sign * arc.sine"),
        f"{_SHADERS}::test_every_way_of_light_is_found",
    ),
    Mutant(
        "a link spreads without regard to its cosine at the vertex",
        edit(_LINKS, "at.cosines.x * at.cosines.y * arc.sine", "at.cosines.x * arc.sine"),
        f"{_SHADERS}::test_a_link_spreads_as_rays_do",
    ),
    Mutant(
        "light seen through a sphere is counted by both sides",
        edit(
            _BESIDE,
            "return rho_of_link(path.chain, surface.position, cosine);",
            "return 0.0;",
        ),
        _LIGHT,
    ),
    Mutant(
        "the camera takes a ray within a ball for one that has left it",
        edit(_LINKS, "chain.state = crosses ? LINKING : INSIDE;", "chain.state = LINKING;"),
        _LIGHT,
    ),
    Mutant(
        "links do not know how few particles take part",
        edit(_LINKS, "frame.particles * frame.linked * share", "frame.particles * share"),
        f"{_PICTURES}::test_however_few_there_are",
    ),
    Mutant(
        "links are weighed as if each branch were always tried",
        edit(_LINKS, "first_slope(arc) >= 0.0 ? 1.0 : falls ? 0.5 : SIDE", "1.0"),
        f"{_SHADERS}::test_branches_are_drawn_as_their_shares_say",
    ),
    Mutant(
        "a link takes one bounce, whatever it passes",
        edit(_CAMERA_LINKS, "depth + 2 + chords > frame", "depth + 2 > frame"),
        f"{_PICTURES}::test_however_few_there_are",
    ),
    Mutant(
        "tinted glass takes nothing from a link",
        edit(_LINKS, "float(2 * arc.chords) * arc.radius", "0.0 * arc.radius"),
        f"{_SHADERS}::test_tinted_glass_takes_its_share_of_each_chord",
    ),
    Mutant(
        "what stands between a ball and the eye hides nothing",
        edit(
            _CAMERA_LINKS,
            "    if (occluded(Ray(way.near, back / reach, index, false), reach, index)) return;\n",
            "",
        ),
        _LIGHT,
    ),
    Mutant(
        "what stands between a vertex and a ball hides nothing",
        edit(_CAMERA_LINKS, " || occluded(ray, distance, index)", ""),
        _LIGHT,
    ),
    Mutant(
        "a link runs about the centre the wrong way round",
        edit(_LINKS, "chords == 1 ? -branch.sign : branch.sign", "branch.sign"),
        f"{_SHADERS}::test_each_branch_is_met",
    ),
]
