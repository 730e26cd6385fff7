// Texels of the carpet's images of a kind.
#include "lib/layered.glsl"
#include "systems/show/carpet/reading.glsl"

uniform ByKind tops;  // by kind: height that the images cover, relative to the canopy's

const float LEAST_TEXEL = 1e-3;  // least coverage, or height, that divides
const float LEAST_MEAN = 0.01;   // least mean coverage of an image that divides
const float HIDES_ALL = 1e-3;    // least transmittance of an image

struct Texel {
    float place;       // along the blade: the share of the tip's pigment
    float height;      // in the canopy, as a fraction of what the images cover
    float cos_double;  // cosine of twice the face normal's azimuth from the line of sight
    float covers;      // coverage
    float mean_cover;  // mean coverage of the images
    float taller;      // excess of its height over the mean, as a fraction of that
    float eyed;        // share of the tip's pigment that is an eye's instead
};

// Opacity of grass at a slope between those of two images, relative to the mean of both. The square of the optical depth is interpolated
// in the square of the path length: exact for leaves oriented as the faces of an ellipsoid (Campbell, as in sun_extinction). Steeper
// slopes count as that of the steepest image.
float opacity_ratio(float flatter, float steeper, int elevation, float slope, float mean) {
    vec2 depth = log(max(1.0 - vec2(flatter, steeper), HIDES_ALL));
    vec3 way = 1.0 / vec3(slopes[elevation], slopes[elevation + 1], clamp(slope, FLATTEST, slopes[SLOPES - 1]));
    way *= way;
    depth *= depth;
    float square = max(mix(depth.y, depth.x, (way.z - way.y) / (way.x - way.y)), 0.0);  // heads may hide more from above
    return (1.0 - transmittance(sqrt(square))) / max(mean, LEAST_MEAN);
}

#ifdef HEADS
const float HEAD_HIGH = 0.06;  // typical height of a head [m]

// Mip levels by which images of heads are read coarser than of leaves. The footprint of a pixel is longer than wide by the reciprocal of
// the slope, and leaves are stretched as far. Heads are not: a pixel `across` [m] wide covers several.
float head_levels(float across, float slope) {
    return 0.5 * log2(max(min(1.0 + across / HEAD_HIGH, 1.0 / max(slope, LOWEST)), 1.0));
}
#endif

#ifdef EYED
// Share of the tip's pigment that is an eye's instead.
float eye_share(vec3 shown) {
    return min(shown.b / max(shown.r, LEAST_TEXEL), 1.0);
}
#endif

// The texel of a kind whose images begin at a layer, with a gain of contrast; `comes` tells whether it is what the kind is to become.
Texel texel_from(float layer, int kind, bool comes, Patch grass_patch, Reading read, float on_level, float grain) {
    layer += float((grass_patch.model * SLOPES + read.elevation) * HEADINGS + grass_patch.side);
    float next = layer + float(HEADINGS);
    vec4 mean_low = layer_mean(images, int(layer), stock.z), mean_high = layer_mean(images, int(next), stock.z);
    vec4 mean = mix(mean_low, mean_high, read.blend);
    vec4 low = layer_at(images, vec3(read.low, layer), read.level), high = layer_at(images, vec3(read.high, next), read.level);
#ifdef HEADS
    // Between scattered heads coverage is 0 and cannot fall below: more contrast would raise the mean.
    if (OF(bears, kind) > 0.0)
        grain = mix(min(grain, 1.0), grain, mean.a);
#endif
    float fill = opacity_ratio(mean_low.a, mean_high.a, read.elevation, on_level, mean.a);
    vec4 image = (mean + (mix(low, high, read.blend) - mean) * grain) * fill;
    image.a = clamp(image.a, 0.0, 1.0);
    image.rgb = clamp(image.rgb, 0.0, image.a);
    vec3 shown = image.rgb / max(image.a, LEAST_TEXEL);
    float taller = shown.g * mean.a / max(mean.g, LEAST_TEXEL) - 1.0;
    float cos_double = 2.0 * shown.b - 1.0, eyed = 0.0;
#ifdef EYED
    if (has_eyes(kind, comes)) {
        eyed = eye_share(shown);
        cos_double = FACING;
    }
#endif
    return Texel(shown.r, shown.g, cos_double, image.a, mean.a * fill, taller, eyed);
}

// Blend of two texels, with a weight `part` of the other.
Texel blended(Texel one, Texel other, float part) {
    float covers = mix(one.covers, other.covers, part), of_other = part * other.covers / max(covers, LEAST_TEXEL);
    return Texel(mix(one.place, other.place, of_other), mix(one.height, other.height, of_other),
                 mix(one.cos_double, other.cos_double, of_other), covers, mix(one.mean_cover, other.mean_cover, part),
                 mix(one.taller, other.taller, of_other), mix(one.eyed, other.eyed, of_other));
}

// The texel of a kind, blended with that of what it is to become. With PLAIN, no kind is to become another.
Texel texel_of(int kind, Patch grass_patch, Reading read, float on_level, float grain) {
#ifdef PLAIN
    return texel_from(OF(first, kind), kind, false, grass_patch, read, on_level, grain);
#else
    float part = OF(came, kind);
    Texel texel = texel_from(part < 1.0 ? OF(first, kind) : OF(coming, kind), kind, part >= 1.0, grass_patch, read, on_level, grain);
    if (part > 0.0 && part < 1.0)
        texel = blended(texel, texel_from(OF(coming, kind), kind, true, grass_patch, read, on_level, grain), part);
    return texel;
#endif
}
