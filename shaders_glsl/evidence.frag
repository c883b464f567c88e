// The bias of history, for tiles of a picture: whether fresh samples differ from it by more than their noise.
//
// In a tile of n pixels the luminances of film and history differ by d on average, with a variance of s2. Their
// noise alone would give a square of s2 / n. The part above MARGIN times that is the square of the bias.

uniform sampler2D light;     // the film under its weights
uniform sampler2D mean;      // of the film; a: finite samples
uniform sampler2D brought;   // history from reproject.frag

out vec4 evidence;           // r: square of the bias, over the variance of one sample

const int TILE = 8;          // pixels along an edge
const float LEAST = 16.0;    // pixels of a tile that have a history; fewer give no evidence
const float MARGIN = 6.0;    // of squares by noise alone, from 64 pixels, 1 in 70 is larger
const vec3 LUMINANCE = vec3(0.2126, 0.7152, 0.0722);

void main() {
    ivec2 corner = TILE * ivec2(gl_FragCoord.xy);
    ivec2 end = min(corner + TILE, textureSize(mean, 0));
    float count = 0.0;
    float sum = 0.0;
    float squares = 0.0;
    float rarity = 0.0;  // sum of the variances of d, where one sample has variance 1
    for (int y = corner.y; y < end.y; y += 1) {
        for (int x = corner.x; x < end.x; x += 1) {
            vec4 history = texelFetch(brought, ivec2(x, y), 0);
            float samples = texelFetch(mean, ivec2(x, y), 0).a;
            if (history.a <= 0.0 || samples <= 0.0) continue;
            float d = dot(texelFetch(light, ivec2(x, y), 0).rgb - history.rgb, LUMINANCE);
            count += 1.0;
            sum += d;
            squares += d * d;
            rarity += 1.0 / samples + 1.0 / history.a;
        }
    }
    evidence = vec4(0.0);
    if (count < LEAST) return;
    float average = sum / count;
    float variance = max(squares / count - average * average, 0.0);
    float bias = max(average * average - MARGIN * variance / count, 0.0);
    float of_one = variance * count / rarity;
    evidence.r = bias > 0.0 ? bias / max(of_one, bias * 1.0e-6) : 0.0;
}
