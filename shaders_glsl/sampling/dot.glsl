// Products that every driver sums in the same order. GLSL leaves the order of its own `dot` open: Mesa 22 sums from the
// end, Mesa 25 from the start. A function of the same name and parameters hides the built-in one, and all its
// overloads.

float dot(vec2 a, vec2 b) {
    float sum = a.x * b.x + a.y * b.y;
    return sum;
}

float dot(vec3 a, vec3 b) {
    float sum = a.x * b.x + (a.y * b.y + a.z * b.z);
    return sum;
}

float length(vec2 v) {
    float root = sqrt(dot(v, v));
    return root;
}

float length(vec3 v) {
    float root = sqrt(dot(v, v));
    return root;
}
