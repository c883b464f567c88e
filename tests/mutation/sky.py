"""Bugs of the sky's sampling."""

from tests.mutation.mutant import Edit, Mutant, edit

_SAMPLING = "lights/sky_sampling.glsl"
_PATH = "integrators/path.glsl"
_TESTS = "truths/test_sky_sampling.py"
_DENSITY = f"{_TESTS}::test_the_density_is_that_of_a_direction_and_integrates_to_one"
_FIGURES = f"{_TESTS}::test_samples_tell_the_density_and_the_radiance_of_their_direction"
_DRAWS = f"{_TESTS}::test_samples_follow_their_density"

_SUN = "truths/test_sun.py"
_CLEAR = "truths/test_clear_sky.py"


def _model(old: str, new: str) -> tuple[Edit, ...]:
    return (Edit("glrt/scene/clear_sky.py", old, new),)


SKY = [
    Mutant(
        "the sun's radiance is that of a disc twice as wide",
        (
            Edit(
                "glrt/scene/sun.py",
                "math.sin(math.radians(self.angle) / 2) ** 2",
                "math.sin(math.radians(self.angle)) ** 2",
            ),
        ),
        f"{_SUN}::test_a_floor_receives_the_irradiance_times_the_sine",
    ),
    Mutant(
        "a wide sun gives its irradiance by its solid angle, not by the cosine",
        (
            Edit(
                "glrt/scene/sun.py",
                "area = math.pi * math.sin(math.radians(self.angle) / 2) ** 2",
                "area = 2 * math.pi * self.versine",
            ),
        ),
        f"{_SUN}::test_a_wide_sun_gives_what_it_says",
    ),
    Mutant(
        "the azimuth of the sun turns the other way",
        (Edit("glrt/scene/sun.py", "flat * math.sin(around)", "-flat * math.sin(around)"),),
        f"{_SUN}::test_the_sun_stands_where_it_is_said_to",
    ),
    Mutant(
        "light of the sun is counted twice: by sampling and by scattering",
        edit(_PATH, "power_heuristic(path.pdf, pdf_sun()) : 0.0", "1.0 : 1.0"),
        f"{_SUN}::test_a_wide_sun_gives_what_it_says",
    ),
    Mutant(
        "the sun has half its density",
        edit(
            "lights/sun.glsl",
            "1.0 / (2.0 * PI * frame.sun_versine)",
            "1.0 / (4.0 * PI * frame.sun_versine)",
        ),
        f"{_SUN}::test_a_floor_receives_the_irradiance_times_the_sine",
    ),
    Mutant(
        "the density of the sky has no sine",
        edit(_SAMPLING, "weight * frame.sky_density / sine", "weight * frame.sky_density"),
        _DENSITY,
    ),
    Mutant(
        "the sky's density reaches the poles as if there were pixels",
        edit(_SAMPLING, "if (row < 0) y = 2.0 * y - 1.0;", "if (row < 0) y = y;"),
        _DENSITY,
    ),
    Mutant(
        "samples of the sky are mirrored",
        edit(_SAMPLING, "vec3(sine * sin(azimuth),", "vec3(-sine * sin(azimuth),"),
        _FIGURES,
    ),
    Mutant(
        "samples of the sky are turned the wrong way",
        edit(
            _SAMPLING,
            "place.x - 0.5 - frame.background_turn",
            "place.x - 0.5 + frame.background_turn",
        ),
        _FIGURES,
    ),
    Mutant(
        "samples lie evenly in a patch of the sky",
        edit(_SAMPLING, "precise float x = u * (a + b) / root;", "precise float x = u;"),
        _DRAWS,
    ),
    Mutant(
        "the sums over patches of the sky take the pixel beside, not the one after",
        (
            Edit(
                "glrt/rendering/sky_table.py",
                "np.roll(framed, -1, axis=1)",
                "np.roll(framed, 1, axis=1)",
            ),
        ),
        _DRAWS,
    ),
    Mutant(
        "the rows at the poles of the sky are as high as others",
        (Edit("glrt/rendering/sky_table.py", "    sums[[0, -1]] /= 2\n", ""),),
        _DENSITY,
    ),
    Mutant(
        "light of the sky is counted twice: by sampling and by scattering",
        edit(_PATH, "power_heuristic(path.pdf, light_pdf) : 0.0", "1.0 : 1.0"),
        f"{_TESTS}::test_a_sun_of_one_pixel_lights_a_floor_as_a_quadrature_says",
    ),
    Mutant(
        "the rounds in which the sky is sampled are not counted",
        (
            Edit(
                "glrt/rendering/schedule.py",
                "rays, choice = rays + 1, choice + levels + 1",
                "rays, choice = rays, choice",
            ),
        ),
        f"{_TESTS}::test_methods_agree_under_a_small_sun",
    ),
    Mutant(
        "the image of a clear sky is mirrored",
        _model("x * np.sin(azimuth) - z", "-x * np.sin(azimuth) - z"),
        f"{_CLEAR}::test_its_image_is_the_formula",
    ),
    Mutant(
        "the tables of a clear sky are those of the haze above",
        _model("table[low - 1] * (1 - share) + table[low] * share", "table[low]"),
        f"{_CLEAR}::test_it_is_the_sky_that_mitsuba_shows",
    ),
    Mutant(
        "a clear sky stands above a ground of the other albedo",
        _model("dark * (1 - ground) + bright * ground", "bright * (1 - ground) + dark * ground"),
        f"{_CLEAR}::test_it_is_the_sky_that_mitsuba_shows",
    ),
    Mutant(
        "the ground below a clear sky is lit by the sky alone",
        _model(" + np.array(sky.sun(sun)) * towards[1]", ""),
        f"{_CLEAR}::test_the_ground_is_lit_by_sun_and_sky",
    ),
    Mutant(
        "the sun of a clear sky is not dimmed by its scale",
        _model("_elevation(towards)) * self.scale", "_elevation(towards))"),
        f"{_CLEAR}::test_scale_is_a_factor_of_sky_and_sun",
    ),
]
