// Light by layers, so that a picture can be weighed again without being rendered again. A layer holds
// the light of a light group or, BY_LENGTH, of the paths of a length. LAYERS 0: none are kept.

const int DIVISOR = LAYERS > 0 ? LAYERS : 1;  // some compilers refuse to divide by a constant 0
const vec3 NO_LAYERS[MOST_LAYERS] = vec3[MOST_LAYERS](
    vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0));

// The last layer takes the light of all layers beyond it.
void add_to_layer(inout vec3 layers[MOST_LAYERS], vec3 light, int layer) {
    for (int i = 0; i < LAYERS; i += 1) {
        if (i == min(layer, LAYERS - 1)) layers[i] += light;
    }
}
