// Random numbers of collisions in media whose density varies. They are no draws of the sampler, as their count differs
// between paths.

uint collision_state = 0u;

void start_collisions(uint seed) {
    collision_state = pcg_hash(~seed);
}

float next_of_collision() {
    collision_state += STEP;
    float value = unit_float(pcg_hash(collision_state));
    return value;
}
