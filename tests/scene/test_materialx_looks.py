"""Materials of MaterialX documents: surfaces, and what they become."""

import math
from pathlib import Path

import pytest

from glrt.scene.materials.principled import Principled
from tests.support.materialx_files import given, left_out, look, material, scene_of

pytest.importorskip("MaterialX", reason="materialx is not installed")

GREY = "0.5, 0.25, 0.125"


def only(folder: Path, surface: str, *inputs: str) -> tuple[Principled, str]:
    """The material of a surface, and what of it was left out."""
    scene = scene_of(folder, material("m", surface, *inputs))
    return look(scene, "m"), left_out(scene)


def test_surfaces_without_inputs_have_the_defaults_of_their_specifications(tmp_path: Path) -> None:
    """And nothing is left out."""
    surfaces = ("standard_surface", "open_pbr_surface", "gltf_pbr", "UsdPreviewSurface")
    scene = scene_of(tmp_path, *(material(f"m{k}", each) for k, each in enumerate(surfaces)))
    assert left_out(scene) == ""
    found = [look(scene, f"m{k}") for k in range(4)]
    assert [it.color for it in found] == [(0.8,) * 3, (0.8,) * 3, (1.0,) * 3, (0.18,) * 3]
    assert [it.roughness for it in found] == [0.2, 0.3, 1.0, 0.5]
    assert [it.metallic for it in found] == [0, 0, 1, 0]
    assert {it.ior for it in found} == {1.5}
    layers = ("clearcoat", "transmission", "iridescence", "anisotropy", "diffuse_transmission")
    assert all(getattr(it, key) == 0 for it in found for key in layers)
    assert all(not any(it.sheen) and not it.emits and it.alpha == 1 for it in found)


def test_metal_of_three_surfaces_is_the_same(tmp_path: Path) -> None:
    """Standard Surface, OpenPBR and glTF."""
    color = "0.9, 0.7, 0.3"
    scene = scene_of(
        tmp_path,
        material(
            "a",
            "standard_surface",
            given("base_color", color, "color3"),
            given("metalness", "1"),
            given("specular_roughness", "0.3"),
        ),
        material(
            "b",
            "open_pbr_surface",
            given("base_color", color, "color3"),
            given("base_metalness", "1"),
        ),
        material("c", "gltf_pbr", given("base_color", color, "color3"), given("roughness", "0.3")),
    )
    first, second, third = (look(scene, name) for name in "abc")
    assert first == second == third
    assert (first.color, first.metallic, first.roughness) == ((0.9, 0.7, 0.3), 1, 0.3)


@pytest.mark.parametrize("strength", [0.1, 0.5, 0.9])
def test_brushed_surfaces_have_the_alphas_of_the_specifications(
    tmp_path: Path, strength: float
) -> None:
    """Along and across the grain; the formulas are those of MaterialX and OpenPBR."""
    standard, lost = only(
        tmp_path,
        "standard_surface",
        given("specular_roughness", "0.4"),
        given("specular_anisotropy", f"{strength}"),
        given("specular_rotation", "0.25"),
    )
    assert lost == ""
    aspect = math.sqrt(1 - strength)
    across, along = standard.facet_alpha, standard.facet_alpha * standard.stretch
    assert across == pytest.approx(0.16 * aspect, rel=1e-5)
    assert along == pytest.approx(min(0.16 / aspect, 1), rel=1e-5)
    assert standard.anisotropy_rotation == 90
    other, lost = only(
        tmp_path,
        "open_pbr_surface",
        given("specular_roughness", "0.4"),
        given("specular_roughness_anisotropy", f"{strength}"),
    )
    assert lost == ""
    across, along = other.facet_alpha, other.facet_alpha * other.stretch
    assert across / along == pytest.approx(1 - strength, rel=1e-5)
    assert (across**2 + along**2) / 2 == pytest.approx(0.16**2, rel=1e-5)


def test_glass_has_its_color_at_its_depth_or_on_its_surface(tmp_path: Path) -> None:
    """A depth of 0 tints the surface; dispersion is by Abbe number."""
    tint = given("transmission_color", "0.5, 0.8, 0.9", "color3")
    deep, lost = only(
        tmp_path,
        "standard_surface",
        given("specular_roughness", "0"),
        given("transmission", "1"),
        given("transmission_depth", "2"),
        given("transmission_dispersion", "40"),
        tint,
    )
    assert lost == ""
    assert (deep.color, deep.transmission, deep.thin) == ((1, 1, 1), 1, False)
    assert (deep.attenuation_color, deep.attenuation_distance) == ((0.5, 0.8, 0.9), 2)
    assert deep.dispersion == 0.5
    shallow, lost = only(tmp_path, "open_pbr_surface", given("transmission_weight", "1"), tint)
    assert lost == ""
    assert (shallow.color, shallow.attenuation_distance) == ((0.5, 0.8, 0.9), None)
    spread = (
        given("transmission_weight", "1"),
        given("specular_roughness", "0"),
        given("transmission_dispersion_scale", "0.5"),
        given("transmission_dispersion_abbe_number", "25"),
    )
    assert only(tmp_path, "open_pbr_surface", *spread)[0].dispersion == 0.4
    pane, lost = only(
        tmp_path,
        "gltf_pbr",
        given("transmission", "1"),
        given("roughness", "0"),
        given("metallic", "0"),
    )
    assert (pane.thin, lost) == (True, "")
    part, lost = only(tmp_path, "standard_surface", given("transmission", "0.5"), tint)
    assert part.color == pytest.approx((0.65, 0.8, 0.85))


def test_coats_fibres_films_and_light(tmp_path: Path) -> None:
    """Weights multiply colors; a film is in nanometres, of OpenPBR in micrometres."""
    standard, lost = only(
        tmp_path,
        "standard_surface",
        given("base", "0.5"),
        given("base_color", GREY, "color3"),
        given("coat", "0.5"),
        given("coat_color", "0.5, 1, 1", "color3"),
        given("coat_roughness", "0.2"),
        given("sheen", "0.5"),
        given("sheen_color", GREY, "color3"),
        given("thin_film_thickness", "300"),
        given("thin_film_IOR", "1.4"),
        given("emission", "4"),
        given("emission_color", GREY, "color3"),
    )
    assert standard.color == (0.25 * 0.75, 0.125, 0.0625)
    assert "coat_color on facets" in lost
    assert (standard.clearcoat, standard.clearcoat_roughness) == (0.5, 0.2)
    assert (standard.sheen, standard.sheen_roughness) == ((0.25, 0.125, 0.0625), 0.3)
    film = (standard.iridescence, standard.iridescence_ior, standard.iridescence_thickness)
    assert film == (1, 1.4, 300)
    assert standard.emission == (2, 1, 0.5)
    other, lost = only(
        tmp_path,
        "open_pbr_surface",
        given("fuzz_weight", "1"),
        given("fuzz_color", GREY, "color3"),
        given("thin_film_weight", "0.5"),
        given("thin_film_thickness", "0.3"),
        given("emission_luminance", "4"),
        given("emission_color", GREY, "color3"),
        given("coat_weight", "1"),
    )
    assert (other.sheen, other.sheen_roughness) == ((0.5, 0.25, 0.125), 0.5)
    assert (other.iridescence, other.iridescence_thickness) == pytest.approx((0.5, 300))
    assert other.emission == (2, 1, 0.5)
    assert lost == "coat_darkening; coat_ior other than 1.5"
    gltf, lost = only(
        tmp_path,
        "gltf_pbr",
        given("emissive", GREY, "color3"),
        given("emissive_strength", "4"),
        given("sheen_color", GREY, "color3"),
        given("sheen_roughness", "0.6"),
        given("clearcoat", "0.5"),
        given("anisotropy_strength", "0.5"),
        given("anisotropy_rotation", f"{math.pi / 2}"),
        given("iridescence", "1"),
    )
    assert lost == ""
    assert (gltf.emission, gltf.sheen, gltf.sheen_roughness) == (
        (2, 1, 0.5),
        (0.5, 0.25, 0.125),
        0.6,
    )
    assert (gltf.clearcoat, gltf.clearcoat_roughness) == (0.5, 0)
    assert (gltf.anisotropy, gltf.anisotropy_rotation) == pytest.approx((0.5, 90))
    assert (gltf.iridescence, gltf.iridescence_thickness) == (1, 100)


def test_opacity_and_thin_walls(tmp_path: Path) -> None:
    """Colors of opacity count by their mean; a thin wall that scatters inside is a leaf."""
    holes, lost = only(tmp_path, "standard_surface", given("opacity", "0.25, 0.5, 0.75", "color3"))
    assert (holes.alpha, lost) == (0.5, "")
    masked, lost = only(
        tmp_path,
        "gltf_pbr",
        given("alpha", "0.5"),
        given("alpha_mode", "1", "integer"),
        given("alpha_cutoff", "0.25"),
    )
    assert (masked.alpha, masked.alpha_cutoff, lost) == (0.5, 0.25, "")
    leaf, lost = only(
        tmp_path,
        "open_pbr_surface",
        given("subsurface_weight", "1"),
        given("subsurface_color", GREY, "color3"),
        given("geometry_thin_walled", "true", "boolean"),
    )
    assert (leaf.diffuse_transmission, lost) == (0.5, "")
    assert leaf.diffuse_transmission_color == (0.5, 0.25, 0.125)
    lamp, lost = only(
        tmp_path, "standard_surface", given("emission", "1"), given("opacity", "0, 0, 0", "color3")
    )
    assert (lamp.alpha, lamp.emission) == (1, (1, 1, 1))
    assert lost == "opacity of what emits"


def test_lobes_without_a_counterpart_are_reported(tmp_path: Path) -> None:
    """By the names of their inputs; scattering below the surface shows its color."""
    wax, lost = only(
        tmp_path,
        "standard_surface",
        given("subsurface", "0.5"),
        given("subsurface_color", "0, 0, 1", "color3"),
        given("diffuse_roughness", "0.5"),
        given("specular_roughness", "2"),
    )
    assert wax.color == pytest.approx((0.4, 0.4, 0.9))
    assert wax.roughness == 1
    for words in ("scattering below the surface", "diffuse_roughness", "outside 0 to 1"):
        assert words in lost
    glass, lost = only(
        tmp_path,
        "standard_surface",
        given("transmission", "1"),
        given("sheen", "1"),
        given("coat", "1"),
        given("thin_film_thickness", "300"),
    )
    assert glass.transmission == 1
    assert lost == "clearcoat over transmission; iridescence of transmission; sheen of transmission"
