// Where surfaces of a deformed object were in the view before, and how they faced.
//
// A fragment counts where the G-buffer has its triangle in front, so no depth is compared.

in vec3 here;                // on the triangle, relative to the eye of this view
in vec3 there;               // the same point of the triangle before, relative to the eye before
uniform sampler2D position;  // of this view
uniform sampler2D normal;
uniform float object;        // 1 + its number

layout(location = 0) out vec4 seen;     // place relative to the eye before, a: 1
layout(location = 1) out vec4 turned;   // unit normal before, a: flags

const float SAME_PLACE = 1e-3;  // most distance off the plane of the triangle, over that from the eye

void main() {
    ivec2 texel = ivec2(gl_FragCoord.xy);
    vec4 surface = texelFetch(position, texel, 0);
    vec4 facing = texelFetch(normal, texel, 0);
    vec3 upright = cross(dFdx(here), dFdy(here));
    vec3 upright_before = cross(dFdx(there), dFdy(there));
    bool has_normals = dot(upright, upright) > 0.0 && dot(upright_before, upright_before) > 0.0;
    if (!has_normals || abs(surface.w - object) > 0.5) discard;
    upright = normalize(upright);
    if (abs(dot(surface.xyz - here, upright)) > SAME_PLACE * length(surface.xyz)) discard;
    seen = vec4(there, 1.0);

    // The shading normal turns with the triangle, by the least turn.
    upright_before = normalize(upright_before);
    float cosine = dot(upright, upright_before);
    if (cosine < -0.99) discard;
    vec3 axis = cross(upright, upright_before);
    vec3 along = axis * (dot(axis, facing.xyz) / (1.0 + cosine));
    turned = vec4(normalize(cosine * facing.xyz + cross(axis, facing.xyz) + along), facing.w);
}
