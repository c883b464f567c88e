// Choice of the lamp that is sampled. Clusters of lamps are weighed at each point by their flux over their
// squared distance, so that near ones are chosen more often. CLUSTERS: how many there are. In a scene of few
// lamps, each lamp is a cluster. With MANY_LIGHTS, the PARTS of the chosen cluster are weighed in the same
// way, and a table chooses a lamp of the part by flux. The flux is that of the last restart, and no lamp's
// share of it is 0: light groups can be dimmed and lit later.

const int MOST_SELECTED = 4;  // lamps: more are read one by one

// Weight of a cluster or a part, seen from the origin of `ray`, whose direction is ignored. It is 0 for the
// lamp that the ray leaves, where this lamp is a cluster of its own.
float cluster_weight(int index, Ray ray) {
    Cluster cluster = cluster_at(index);
    if (cluster.shape == ray.origin_shape) return 0.0;
    vec3 away = cluster.center - ray.origin;
    float weight = cluster.probability / max(dot(away, away), cluster.reach2);
    if (IS_AIMED) weight *= share_towards(aim_at(index), -away);
    return weight;
}

// The weight of a cluster whose number differs between lanes. Few are all weighed, as all lanes read the same row then.
float weight_of_any(int index, Ray ray) {
    if (CLUSTERS > MOST_SELECTED) return cluster_weight(index, ray);
    float weight = 0.0;
    for (int i = 0; i < CLUSTERS; ++i) {
        float other = cluster_weight(i, ray);
        weight = i == index ? other : weight;
    }
    return weight;
}

// A lamp whose number differs between lanes.
Light any_light(int index) {
    if (MANY_LIGHTS || CLUSTERS > MOST_SELECTED) return light_at(index);
    Light light = light_at(0);
    for (int i = 1; i < CLUSTERS; ++i) {
        Light other = light_at(i);
        if (i == index) light = other;
    }
    return light;
}

// Weight of all lamps together.
float total_weight(Ray ray) {
    float total = 0.0;
    for (int i = 0; i < CLUSTERS; ++i) total += cluster_weight(i, ray);
    return total;
}

int choose_cluster(Ray ray, float total, float u) {
    float target = u * total;
    float sum = 0.0;
    int chosen = 0;
    for (int i = 1; i < CLUSTERS; ++i) {
        sum += cluster_weight(i - 1, ray);
        if (sum <= target) chosen = i;
    }
    return chosen;
}

int first_part(int cluster) { return CLUSTERS + PARTS * cluster; }

// Weight of all parts of a cluster together.
float parts_weight(int cluster, Ray ray) {
    float total = 0.0;
    for (int i = 0; i < PARTS; ++i) total += cluster_weight(first_part(cluster) + i, ray);
    return total;
}

int choose_part(int cluster, Ray ray, float u) {
    float target = u * parts_weight(cluster, ray);
    float sum = 0.0;
    int chosen = first_part(cluster);
    for (int i = 1; i < PARTS; ++i) {
        sum += cluster_weight(first_part(cluster) + i - 1, ray);
        if (sum <= target) chosen = first_part(cluster) + i;
    }
    return chosen;
}

// The alias method (Vose 1991): one number chooses a lamp, however many there are.
int choose_by_table(Cluster part, float u) {
    float scaled = u * float(part.count);
    int index = min(int(scaled), part.count - 1);
    Light light = light_at(part.first + index);
    float rest = scaled - float(index);
    return rest < light.keep ? part.first + index : light.alias & 0xFFFF;
}

// NO_LIGHT where none can be seen: no lamp at all, or none of the cluster that was chosen.
int choose_light(Ray ray, float total, vec3 u) {
    int cluster = choose_cluster(ray, total, u.x);
    if (IS_AIMED && CLUSTERS > 1 && total == 0.0) return NO_LIGHT;
    if (IS_AIMED && MANY_LIGHTS && parts_weight(cluster, ray) == 0.0) return NO_LIGHT;
    return MANY_LIGHTS ? choose_by_table(cluster_at(choose_part(cluster, ray, u.y)), u.z) : cluster;
}

// Probability to choose a lamp, other than the one just left. `total`: the weight of all lamps together.
float choice_pdf(int index, Ray ray, float total) {
    if (!MANY_LIGHTS) {
        if (CLUSTERS == 1) return 1.0;
        if (IS_AIMED && total == 0.0) return 0.0;  // none can be seen
        float pdf = weight_of_any(index, ray) / total;
        return pdf;
    }
    Light light = light_at(index);
    int part = light.alias >> 16;
    int cluster = (part - CLUSTERS) / PARTS;
    float parts = parts_weight(cluster, ray);
    if (IS_AIMED && (total == 0.0 || parts == 0.0)) return 0.0;  // none can be seen
    float chance = cluster_weight(part, ray) / parts;
    float pdf = cluster_weight(cluster, ray) / total * chance * light.share;
    return pdf;
}
