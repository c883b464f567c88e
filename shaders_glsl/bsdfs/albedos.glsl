// Directional albedos of facets that scatter once, by quadrature on the host: two numbers at steps of the
// root of the cosine.

const int ALBEDO_STEPS = 64;

// The two numbers at an angle to the normal; `first`: the first row of the table.
vec2 albedos(int first, float cosine) {
    float place = sqrt(min(cosine, 1.0)) * float(ALBEDO_STEPS);
    int step = min(int(place), ALBEDO_STEPS - 1);
    float beyond = place - float(step);
    Albedo row = albedo_at(first + step);
    vec2 start = vec2(row.one, row.other);
    vec2 end = vec2(row.one_end, row.other_end);
    vec2 share = start + beyond * (end - start);
    return share;
}
