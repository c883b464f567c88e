// Which lamp is sampled. Few lamps are weighed at each point, by their flux over their squared
// distance, so that near ones are chosen more often; of many, a table chooses by flux alone.
// FEW_LIGHTS: how many there are; 0: many. The flux is that of the last restart, and no lamp's
// share of it is 0: light groups can be dimmed and lit later.

// From the origin of `ray`, whose direction is ignored; 0 for the lamp that it leaves.
float light_weight(Light light, Ray ray) {
    if (light.shape == ray.leaves) return 0.0;
    vec3 away = light.center - ray.origin;
    float weight = light.probability / max(dot(away, away), light.reach2);
    return weight;
}

// Of all lamps together.
float total_weight(Ray ray) {
    float total = 0.0;
    for (int i = 0; i < FEW_LIGHTS; ++i) total += light_weight(light_at(i), ray);
    return total;
}

// How likely a lamp is chosen where all together have the weight `total`.
float choice_pdf(Light light, Ray ray, float total) {
    if (FEW_LIGHTS == 1) return 1.0;
    if (FEW_LIGHTS == 0) return light.probability;
    float pdf = light_weight(light, ray) / total;
    return pdf;
}

// The alias method (Vose 1991): one number chooses a lamp, however many there are.
int choose_by_table(float u) {
    float scaled = u * float(light_count());
    int index = min(int(scaled), light_count() - 1);
    Light light = light_at(index);
    float rest = scaled - float(index);
    return rest < light.keep ? index : light.alias;
}

int choose_light(Ray ray, float total, float u) {
    if (FEW_LIGHTS == 0) return choose_by_table(u);
    float target = u * total;
    float sum = 0.0;
    int chosen = 0;
    for (int i = 1; i < FEW_LIGHTS; ++i) {
        sum += light_weight(light_at(i - 1), ray);
        if (sum <= target) chosen = i;
    }
    return chosen;
}
