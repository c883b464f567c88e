"""Bugs of denoising: what is estimated, from which half, and where the filter is believed."""

from tests.mutation.mutant import Edit, Mutant


def mutant(name: str, file: str, old: str, new: str, test: str) -> Mutant:
    """One edit of a module of glrt."""
    return Mutant(name, (Edit(f"glrt/{file}", old, new),), test)


RISK, BLEND, NLM = "denoise/risk.py", "denoise/blend.py", "denoise/nlm.py"
HALVER = "rendering/halver.py"

DENOISING = [
    mutant(
        "the noise of the half that judges counts as error of the filter",
        RISK,
        "np.square(a - second.radiance) - second.variance",
        "np.square(a - second.radiance)",
        "denoise/test_risk.py::test_of_a_constant_it_is_the_squared_bias",
    ),
    mutant(
        "the errors of both halves are taken for one",
        RISK,
        "second.share * of_second - between",
        "second.share * of_second",
        "denoise/test_risk.py::test_without_a_filter_it_is_the_variance_of_the_plain_picture",
    ),
    mutant(
        "each half counts as much as the other",
        RISK,
        "first.share * of_first + second.share * of_second",
        "0.5 * of_first + 0.5 * of_second",
        "denoise/test_risk.py::test_of_a_blur_it_is_bias_and_variance_in_closed_form",
    ),
    mutant(
        "a half is judged by itself",
        RISK,
        "np.square(a - second.radiance) - second.variance",
        "np.square(a - first.radiance) - first.variance",
        "denoise/test_risk.py::test_without_a_filter_it_is_the_variance_of_the_plain_picture",
    ),
    mutant(
        "the second half holds the first one too",
        "image/halves.py",
        "without(all_, early)",
        "all_",
        "image/test_halves.py::test_each_half_is_a_render_of_its_samples",
    ),
    mutant(
        "particles bring no variance to a half",
        "image/halves.py",
        "np.sum(variances, axis=0, dtype=np.float32)",
        "variances[0]",
        "image/test_halves.py::test_each_half_is_a_render_of_its_samples",
    ),
    mutant(
        "the distance of the halves' means stays in the variance of the second",
        "image/moments.py",
        "first.variance * first.observations - between",
        "first.variance * first.observations",
        "image/test_halves.py::test_what_was_put_together_comes_apart",
    ),
    mutant(
        "a filter is believed however wrong it is",
        BLEND,
        "np.maximum(apart - expected - SPARED * noise, 0)",
        "0 * np.maximum(apart - expected - SPARED * noise, 0)",
        "denoise/test_blend.py::test_a_filter_that_is_wrong_is_not_where_it_is_wrong",
    ),
    mutant(
        "a lamp without noise is judged by the noise of the wall beside it",
        BLEND,
        "parts = np.log(light + floor), half",
        "parts = 0 * light, half",
        "denoise/test_blend.py::test_light_without_noise_is_not_judged_by_the_noisy_wall_beside_it",
    ),
    mutant(
        "guides do not tell neighbours apart that a filter judges",
        BLEND,
        "half.albedo.mean, half.normal.mean",
        "0 * half.albedo.mean, 0 * half.normal.mean",
        "denoise/test_blend.py::test_light_without_noise_is_not_judged_by_the_noisy_wall_beside_it",
    ),
    mutant(
        "a pixel that none looks like is judged as surely as others",
        BLEND,
        " + noise / count",
        "",
        "denoise/test_blend.py::test_what_few_look_like_is_trusted_half",
    ),
    mutant(
        "a filter is believed to be right to any digit",
        BLEND,
        " + flaw",
        "",
        "denoise/test_blend.py::test_no_filter_is_better_than_a_percent",
    ),
    mutant(
        "the window shows what was denoised before an edit",
        "view/state/denoised_picture.py",
        "        if of != self._of:\n",
        "        if self._of is None:\n",
        "view/test_denoised_picture.py::test_an_edit_begins_anew",
    ),
    mutant(
        "the window's frames pass by the middle of the samples",
        "view/state/session.py",
        "            target = min(target, self.stop or target)\n",
        "",
        "view/test_denoised_picture.py::test_it_is_what_a_render_makes",
    ),
    mutant(
        "a denoiser is recommended whatever the limit of bounces leaves out",
        "analysis/method_choice/denoised.py",
        "math.hypot(found.error_high, bias.most)",
        "found.error_high",
        "analysis/test_denoised_choice.py::test_what_longer_paths_leave_out_counts",
    ),
    mutant(
        "of layers the rest keeps the light of the first samples",
        "image/layer_sums.py",
        "sums = self.means * self.counts - first.means * first.counts",
        "sums = self.means * counts",
        "image/test_layer_sums.py::test_the_rest_is_what_its_own_observations_make",
    ),
    mutant(
        "halves of layers are taken to be of one size",
        "image/layer_sums.py",
        "* share[0] * share[1]",
        "/ 4",
        "image/test_layer_sums.py::test_the_variance_is_right_on_average_for_halves_of_any_size",
    ),
    mutant(
        "a dimmed lamp leaves the variance of a half as it was",
        "rendering/weighting.py",
        "variance=own.variance * factor**2",
        "variance=own.variance",
        "view/test_denoised_picture.py::test_relit_lamps_are_denoised_by_their_weights",
    ),
    mutant(
        "noise of colours counts as a difference",
        NLM,
        "np.square(color[here] - color[there]) - 2 * np.minimum(a, b)",
        "np.square(color[here] - color[there])",
        "denoise/test_nlm.py::test_it_is_the_mean_that_its_definition_gives",
    ),
    mutant(
        "normals guide nothing",
        NLM,
        "zip(half.guides, spans, strict=True)",
        "zip(half.guides[:1], spans[:1], strict=True)",
        "denoise/test_nlm.py::test_it_is_the_mean_that_its_definition_gives",
    ),
    mutant(
        "of a render that looks at its error at doublings the first half is kept alone",
        HALVER,
        "return is_stop or not self._kept",
        "return not self._kept",
        "rendering/test_halver.py::test_looks_at_doublings_have_their_middle",
    ),
    mutant(
        "a render goes beyond its samples to keep a half",
        HALVER,
        "            or samples >= target\n",
        "",
        "rendering/test_halver.py::test_what_is_shown_is_made_of_the_middle_and_the_end",
    ),
    mutant(
        "a render stops at an estimate that chance has made low",
        "image/image.py",
        "self.denoising.error_high",
        "self.denoising.error",
        "rendering/test_halver.py::test_a_render_that_ends_anywhere_is_denoised",
    ),
]
