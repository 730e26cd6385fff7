#include "lib/clouds.glsl"
#include "lib/light.glsl"

in vec3 ray;
in vec3 light;
out vec4 pixel;

const vec2 LIMB = vec2(0.00443, 0.00483);  // sines between which the sun's disc ends, which is 0.53 degrees wide half-way
const float DISC = 12.0;     // radiance of the disc, of a white leaf's in full sun: far above white
const vec2 AUREOLE = vec2(0.35, 900.0);  // radiance of the aureole about it, of the same, and how narrow it is
const float GREYS = 255.0;  // steps that a picture has from black to white
const vec3 GRIT = vec3(0.06711056, 0.00583715, 52.9829189);  // interleaved gradient noise (Jimenez, Next Generation Post Processing, 2014)

in vec3 clouding;
flat in vec3 shaded_from;

// How dense the map of clouds is at a place of it: at their bases, and above.
float dense_at(vec2 at) {
    return textureLod(repeating, at, clouding.z + CLOUD_LEVEL).r;
}

float dense_above(vec2 at) {
    return textureLod(repeating, at, clouding.z + CLOUD_ABOVE).r;
}

// The parts of three sections of a line of sight that lie in clouds, by how much denser than at their edges the map is at the ends.
vec3 within(vec4 denser) {
    vec4 inside = max(denser, 0.0), off = abs(denser);
    return (inside.xyz + inside.yzw) / (off.xyz + off.yzw + LEAST_PART);
}

// Clouds in a direction: how much is seen past them, and what they send of the sun's light, and of light in full shade.
vec3 clouds_in(vec3 toward) {
    vec2 along = clouds_toward(toward), at = clouds_over(eye.xz) + along, up = along * CLOUD_RISE;
    vec4 dense = vec4(dense_at(at), dense_above(at + up * CLOUD_HEIGHTS.y), dense_above(at + up * CLOUD_HEIGHTS.z), dense_above(at + up));
    vec4 denser = dense - cloud_edge - CLOUD_ROUND * CLOUD_HEIGHTS * CLOUD_HEIGHTS, inside = max(denser, 0.0);
    vec3 held = within(denser), past = comes_through(0.5 * CLOUD_THICK * CLOUD_HEIGHTS.y * held * (inside.xyz + inside.yzw));
    vec3 shows = (1.0 - past) * vec3(1.0, past.x, past.x * past.y), enters = (1.0 - held) * step(denser.xyz, vec3(0.0));
    float hides = shows.x + shows.y + shows.z, one = 1.0 / max(hides, LEAST_PART);
    float high = one * dot(shows, CLOUD_HEIGHTS.xyz + CLOUD_HEIGHTS.y * enters);
    float deep = one * dot(shows, mix(dense.xyz, dense.yzw, enters));
    float aside = dense_at(at + up * high + shaded_from.xy) - deep;
    float shades = shaded_from.z * clamp(aside, CLOUD_MOST_SHADED.x, CLOUD_MOST_SHADED.y);
    float sunny = clamp(CLOUD_LIT + CLOUD_HIGHER_UP * high - CLOUD_DEEPER * (deep - cloud_edge) - CLOUD_SHADES * shades, 0.0, 1.0);
    float lit = CLOUD_SUNLIT * sunny * sunny + CLOUD_SILVER * clouding.x * pow(max(1.0 - hides, LEAST_SQUARE), CLOUD_STRAYS);
    float shaded = (1.0 + CLOUD_HIGHER * high) * (CLOUD_PALE - CLOUD_DARK * (deep + CLOUD_MOTTLED * shades));
    hides *= clouding.y;
    return vec3(1.0 - hides, hides * lit, hides * shaded);
}

// What the sun itself and the air about it send, of its light, by the cosine of the angle to it.
float glow(float cosine) {
    float aside = cosine > 0.0 ? 1.0 - cosine * cosine : 1.0, aureole = 1.0 / (1.0 + AUREOLE.y * aside);
    return DISC - DISC * smoothstep(LIMB.x * LIMB.x, LIMB.y * LIMB.y, aside) + AUREOLE.x * aureole * aureole;
}

void main() {
    vec3 toward = ray * inversesqrt(dot(ray, ray)), seen = light;
    float sunny = toward.y > 0.0 ? glow(dot(toward, sun)) : 0.0;
    if (cloud_edge <= 1.0) {
        vec3 clouds = clouds_in(toward);
        seen = seen * clouds.x + cloudlight * clouds.z;
        // Low down, the sun is seen past them as in the mean.
        sunny = clouds.y + sunny * (clouds.x - (1.0 - clamp(cloud_edge, 0.0, 1.0)) * (1.0 - clouding.y));
    }
    seen += sunlight * sunny;
    float grit = fract(GRIT.z * fract(dot(gl_FragCoord.xy, GRIT.xy))) - 0.5;
    pixel = vec4(shown_of(seen) + (writes_raw > 0.5 ? 0.0 : grit / GREYS), 1.0);
}
