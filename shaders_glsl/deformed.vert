// Corners of triangles of a deformed object, on the pixels of this view: row 0 is on top.

in vec3 corner;         // relative to the eye of this view
in vec3 corner_before;  // relative to the eye before
uniform vec3 right;     // of the camera of this view: half the width and height of the frame, at distance 1
uniform vec3 up;
uniform vec3 forward;   // unit
uniform vec2 frame;     // size of its full frame, pixels
uniform vec2 origin;    // origin of its crop
uniform vec2 size;      // of the picture, pixels

out vec3 here;
out vec3 there;

void main() {
    here = corner;
    there = corner_before;
    float depth = dot(corner, forward);
    vec2 aside = vec2(dot(corner, right) / dot(right, right), -dot(corner, up) / dot(up, up));
    vec2 place = 0.5 * (vec2(depth) + aside) * frame - origin * depth;  // times the depth
    gl_Position = vec4(2.0 * place / size - vec2(depth), 0.0, depth);   // no depth test: see deformed.frag
}
