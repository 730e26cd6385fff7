// What the carpet's images show of a kind.
#include "lib/layered.glsl"
#include "systems/show/carpet/reading.glsl"

uniform ByKind tops;  // by kind: how high the images reach, of the canopy's height

const float LEAST_TEXEL = 1e-3;  // coverage, or height, that divides another at least
const float LEAST_MEAN = 0.01;   // mean coverage of an image that does
const float HIDES_ALL = 1e-3;    // what is seen through an image at least

struct Texel {
    float place;   // along the blade: what part of the tip's pigment it has
    float height;  // in the canopy
    float twice;   // cosine of twice the azimuth that the face has from the line of sight
    float covers;  // coverage
    float usual;   // mean coverage
    float taller;  // how much higher it is than the mean, of that
    float eyed;    // of what has the tip's pigment, how much has an eye's instead
};

// How much more grass hides, seen at a slope between those of two images, than the mean of both. Both show which optical depth it has
// there, and its square goes by that of a way through the grass: so it does where leaves lie in all directions as the faces of an
// ellipsoid (Campbell, as sun_extinction has it). What is seen straight from above is taken for the steepest image.
float filled(float flatter, float steeper, int elevation, float slope, float mean) {
    vec2 depth = log(max(1.0 - vec2(flatter, steeper), HIDES_ALL));
    vec3 way = 1.0 / vec3(slopes[elevation], slopes[elevation + 1], clamp(slope, FLATTEST, slopes[SLOPES - 1]));
    way *= way;
    depth *= depth;
    float square = max(mix(depth.y, depth.x, (way.z - way.y) / (way.x - way.y)), 0.0);  // heads may hide more from above
    return (1.0 - transmittance(sqrt(square))) / max(mean, LEAST_MEAN);
}

#ifdef HEADS
const float HEAD_HIGH = 0.06;  // how high a head is, about [m]

// How much coarser images of heads are read than of leaves, in levels. A pixel is a stripe of ground, by the reciprocal of the
// slope as long as it is broad, and leaves are drawn out as far. Heads are not: a pixel so broad [m] takes in several.
float coarser_heads(float across, float slope) {
    return 0.5 * log2(max(min(1.0 + across / HEAD_HIGH, 1.0 / max(slope, LOWEST)), 1.0));
}
#endif

#ifdef EYED
// Of what an image shows in the tip's pigment, how much has that of an eye.
float eyed_of(vec3 shown) {
    return min(shown.b / max(shown.r, LEAST_TEXEL), 1.0);
}
#endif

// The texel of images from a layer on, whose grain is so far from the mean, of how far it is in images.
Texel texel_from(float layer, int kind, bool comes, Patch own, Reading read, float on_level, float grain) {
    layer += float((own.model * SLOPES + read.elevation) * HEADINGS + own.side);
    float next = layer + float(HEADINGS);
    vec4 mean_low = layer_mean(images, int(layer), stock.z), mean_high = layer_mean(images, int(next), stock.z);
    vec4 mean = mix(mean_low, mean_high, read.next);
    vec4 low = layer_at(images, vec3(read.low, layer), read.level), high = layer_at(images, vec3(read.high, next), read.level);
#ifdef HEADS
    // Between what is scattered there is nothing, which cannot be less than that: more grain would be more of it in the mean.
    if (OF(bears, kind) > 0.0)
        grain = mix(min(grain, 1.0), grain, mean.a);
#endif
    float fill = filled(mean_low.a, mean_high.a, read.elevation, on_level, mean.a);
    vec4 image = (mean + (mix(low, high, read.next) - mean) * grain) * fill;
    image.a = clamp(image.a, 0.0, 1.0);
    image.rgb = clamp(image.rgb, 0.0, image.a);
    vec3 shown = image.rgb / max(image.a, LEAST_TEXEL);
    float taller = shown.g * mean.a / max(mean.g, LEAST_TEXEL) - 1.0;
    float twice = 2.0 * shown.b - 1.0, eyed = 0.0;
#ifdef EYED
    if (has_eyes(kind, comes)) {
        eyed = eyed_of(shown);
        twice = FACING;
    }
#endif
    return Texel(shown.r, shown.g, twice, image.a, mean.a * fill, taller, eyed);
}

// What a part of one texel's grass and the rest of another's show together.
Texel together(Texel one, Texel other, float part) {
    float covers = mix(one.covers, other.covers, part), of_other = part * other.covers / max(covers, LEAST_TEXEL);
    return Texel(mix(one.place, other.place, of_other), mix(one.height, other.height, of_other), mix(one.twice, other.twice, of_other),
                 covers, mix(one.usual, other.usual, part), mix(one.taller, other.taller, of_other), mix(one.eyed, other.eyed, of_other));
}

// The texel of a kind, and of what it is to be as far as it has become that. Programs that are made for none are told so by PLAIN.
Texel texel_of(int kind, Patch own, Reading read, float on_level, float grain) {
#ifdef PLAIN
    return texel_from(OF(first, kind), kind, false, own, read, on_level, grain);
#else
    float part = OF(came, kind);
    Texel texel = texel_from(part < 1.0 ? OF(first, kind) : OF(coming, kind), kind, part >= 1.0, own, read, on_level, grain);
    if (part > 0.0 && part < 1.0)
        texel = together(texel, texel_from(OF(coming, kind), kind, true, own, read, on_level, grain), part);
    return texel;
#endif
}
