// A film and the history of the view, weighed by their mean squared errors. Samples of both have the same noise, so
// that variances are proportional to 1 over their numbers; history also has a bias. As the film grows, history fades
// out.

uniform sampler2D light;     // the film under its weights
uniform sampler2D mean;      // of the film; a: finite samples
uniform sampler2D brought;   // history from reproject.frag
uniform sampler2D evidence;  // bias of history, from evidence.frag
uniform float samples;       // of the film
uniform float end;           // samples of the film from which on only the film is shown

out vec4 shown;              // radiance, and the samples that it stands for

const int TILE = 8;          // as in evidence.frag

void main() {
    ivec2 texel = ivec2(gl_FragCoord.xy);
    vec4 history = texelFetch(brought, texel, 0);
    vec3 fresh = texelFetch(light, texel, 0).rgb;
    float count = texelFetch(mean, texel, 0).a;
    ivec2 tile = texel / TILE;
    float trusted = history.a / (1.0 + history.a * texelFetch(evidence, tile, 0).r);
    float left = trusted * max(1.0 - samples / end, 0.0);
    shown = vec4(fresh, count);
    if (left <= 0.0) return;
    float share = left / (left + count);
    shown = vec4(fresh + share * (history.rgb - fresh), left + count);
}
