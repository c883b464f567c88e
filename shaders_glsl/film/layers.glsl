// Light by layers, so that a picture can be weighed anew without being rendered anew: a layer holds
// what a light group gives or, BY_LENGTH, what the paths of a length give. LAYERS 0: none are kept.

const int DIVISOR = LAYERS > 0 ? LAYERS : 1;  // some compilers refuse to divide by a constant 0
const vec3 NO_LAYERS[MOST_LAYERS] = vec3[MOST_LAYERS](
    vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0));

// The last layer takes all that are beyond it.
void add_to_layer(precise inout vec3 layers[MOST_LAYERS], vec3 light, int layer) {
    for (int i = 0; i < LAYERS; i += 1) {
        if (i == min(layer, LAYERS - 1)) layers[i] += light;
    }
}
