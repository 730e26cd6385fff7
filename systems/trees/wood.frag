#include "lib/light.glsl"
#include "systems/trees/leaf.glsl"
#include "systems/trees/shown.glsl"
#include "systems/trees/far.py"
#include "systems/trees/noise.py"

uniform sampler2DArray tree_cards;  // in place of twigs' cards: tileable noise

in vec2 on_skin;
in vec3 facing;
in vec3 seen_at;
#ifdef BAKED
in vec4 inside;
#else
in vec3 from_sun;
in vec3 from_sky;
flat in vec3 hazy;
#endif
in float thick;
flat in float rounds;
in vec2 fading;
in float aged;
in float stands;
flat in vec2 among_grass;

#ifdef BAKED
layout(location = 0) out vec4 pixel;
layout(location = 1) out vec4 second;
#else
out vec4 pixel;
#endif

const vec2 FURROWS = vec2(26.0, 4.0), BANDS = vec2(5.0, 26.0);  // number per metre around and along a stem
const float WINDINGS = 6.0;  // bends of furrows per metre
const float FINER = 3.1;  // frequency of cracks, of the furrows'
const float DEEP = 0.7;  // share of furrows in the brightness of bark, beside cracks
const vec2 RIDGES = vec2(0.55, 0.75);  // brightness of a furrow's ground, of the bark's, and added brightness of a ridge
const vec2 BAND = vec2(0.58, 0.74);  // noise over which a band fades in
const vec3 BANDED = vec3(0.7, 0.5, 1.7);  // of that noise, the part all over, and the part in spots; spots per metre
const vec2 FOOT = vec2(0.1, 1.2);  // positions along a stem between which its foot ends, which has dark spots [m]
const vec2 SPOTS = vec2(9.0, 5.0);  // spots per metre around and along it
const vec2 SPOT = vec2(0.28, 0.5);  // noise over which a spot fades in
const float BAND_TONE = 0.42;  // brightness of bands and spots, of the bark's
const vec2 FINEST_BARK = vec2(1.5, 18.0);  // furrows show where a pixel is under 1/36 m of bark, and vanish over 1/12;
const float BROADER = 4.0;  // bands are larger, and show at pixels as many times as large
const float SHARPER = 1.7;  // contrast gain in pictures of trees, whose texels are interpolated
const float SOFTER = 1.2;  // widening of a band's fade by the size of a pixel [1/m]

const float SHARPER_BY = -1.5, BANDS_SHARPER = -2.5;  // bias of the noise's mip level: furrows and bands are its peaks, which a mean would lose

#ifdef SOFT
// Brightness of the bark, of its mean.
float bark_there() {
    return soiled_at(stands);
}
#else
float noise(vec2 at, float sharper) {
    return texture(tree_cards, vec3(at * (1.0 / NOISE_CELLS), 0.0), sharper).r;
}

float noise(vec2 at) {
    return noise(at, SHARPER_BY);
}

// Brightness of bark with dark bands across its stem, of its ground.
float banded_at(vec2 on, float broad, float pixel) {
    float band = smoothstep(BAND.x - SOFTER * pixel, BAND.y + SOFTER * pixel, noise(on * BANDS, BANDS_SHARPER) * (BANDED.x + BANDED.y * broad));
    float foot = (1.0 - smoothstep(FOOT.x, FOOT.y, on.y)) * smoothstep(SPOT.x, SPOT.y, noise(on * SPOTS));
    return mix(1.0, BAND_TONE, max(band, foot));
}

// Brightness of bark with furrows along its stem, of its ground.
float furrowed_at(vec2 on, float broad) {
    float furrows = noise(on * FURROWS + 2.0 * broad), cracks = noise(on * (FURROWS * FINER));
    return mix(1.0, RIDGES.x + RIDGES.y * (DEEP * furrows + (1.0 - DEEP) * cracks), rough);
}

// Brightness of old bark, of its ground: furrows along it, or dark bands across it; and the broadest octave of its noise.
vec2 old_bark_there() {
    float pixel = max(fwidth(on_skin.x), fwidth(on_skin.y)), finest = FINEST_BARK.y / (rough < 0.0 ? BROADER : 1.0);
    float broad = noise(on_skin * (rough < 0.0 ? BANDED.z : WINDINGS));
    float old = rough < 0.0 ? banded_at(on_skin, broad, pixel) : furrowed_at(on_skin, broad);
    return vec2(mix(bark_mean(), old, clamp(FINEST_BARK.x - finest * pixel, 0.0, 1.0)), broad);
}

// Brightness of the bark, of its ground.
float bark_there() {
    vec2 old = old_bark_there();
    return soiled_at(stands + old.y - 0.5) * mix(1.0, old.x, aged);
}
#endif

// Coverage of a stem with soft edges. The part of `facing` across the ray is the distance from its middle.
float edge_cover(vec3 ray) {
    float across = fading.y * length(facing - dot(facing, ray) * ray);
    return mix(1.0, clamp((1.0 - across) / max(fwidth(across), LEAST_WIDTH), 0.0, 1.0), fading.x);
}

void main() {
#ifdef BAKED
    float worn = mix(1.0, old_bark_there().x / bark_mean(), aged_at(aged * THICKEST));
    pixel = vec4(0.5 + 0.5 * SHARPER * (worn - 1.0), 1.0, aged, 1.0);
    second = packed_shading(inside);
#else
    float worn = bark_there();
    vec3 ray = normalize(seen_at - eye);
    float cover = thick * edge_cover(ray);
    must_cover(cover);
    vec3 out_to = facing - ray * (rounds * sqrt(max(1.0 - dot(facing, facing), 0.0)));
    float lit = max(dot(out_to, sun), 0.0) * inversesqrt(dot(out_to, out_to));
    vec2 seen = transmittance(vec2(among_grass.y, OPEN_SKY) * leaf_area_above(stands, vec2(0.0, among_grass.x)));
    pixel = drawn(worn * worn * (from_sun * (lit * seen.x) + from_sky * seen.y) + hazy, cover);
#endif
}
