// Pigments: roots of albedos, which interpolate as the eye expects.
#include "lib/sown.glsl"

const vec2 STRETCHES = vec2(0.16, 0.14);  // amplitude of the two slow noises: in brightness, and from fresh to dry
const vec3 DRIER = vec3(1.0, 0.1, -0.9);  // share of red, green and blue in the second

// Factor on pigments of drier and fresher stretches of land.
vec3 dryness_tint(vec2 slow) {
    return 1.0 + STRETCHES.x * slow.x + STRETCHES.y * slow.y * DRIER;
}

// Pigment of a kind's blades at a part of their length.
vec3 pigment_at(int kind, float part) {
    return mix(kinds[kind].root, kinds[kind].tip, part);
}

// The same, with the share `eyed` of the pigment of a head's eye.
vec3 pigment_at(int kind, float part, float eyed) {
#ifdef EYED
    return pigment_at(kind, part) + eyed * (kinds[kind].eye_pigment - kinds[kind].tip);
#else
    return pigment_at(kind, part);
#endif
}

// Whether heads of a kind have an eye; with `comes`, those that it is changing into.
bool has_eyes(int kind, bool comes) {
    float eyed = kinds[kind].eyed;
    return comes ? eyed >= 2.0 : mod(eyed, 2.0) >= 1.0;
}

// Factor on pigments by the azimuth of a blade's normal: `twice` is the cosine and sine of twice that.
vec3 azimuth_tint(int kind, vec2 twice) {
    return 1.0 + kinds[kind].grain_c * twice.x + kinds[kind].grain_s * twice.y;
}

// Cosine and sine of twice an angle, from its own.
vec2 doubled_angle(vec2 angle) {
    return vec2(angle.x * angle.x - angle.y * angle.y, 2.0 * angle.x * angle.y);
}

// Mean cosine of twice the azimuth to the eye over what is seen of blades that face all ways: 1/3 by their apparent breadth alone,
// and more, as broad ones hide narrow ones. Measured on slopes and level ground, with and without wind.
const float FACING = 0.43;

// Mean cosine and sine of twice the azimuth of the blades that a line of sight meets, where they lean along `lean` and face all
// ways. Upright blades are seen most where they face the eye; the more from above leaning ones are seen, the less that matters.
vec2 seen_azimuth(int kind, vec3 lean, vec3 ray) {
    vec2 across = cross(lean, ray).xz;
    float lies = OF(lying, kind) * lean.y * ray.y, all = dot(across, across);
    return FACING / max(all + lies * lies, LEAST_SQUARE) * vec2(across.y * across.y - across.x * across.x, -2.0 * across.x * across.y);
}

// Mean pigment of kinds, by weights; `tipped` is the share of the tip's pigment in each.
vec3 mean_pigment(ByKind weights, ByKind tipped) {
    vec3 low = vec3(0.0);
    for (int kind = 0; kind < KINDS; kind++)
        low += OF(weights, kind) * pigment_at(kind, OF(tipped, kind));
    return low / max(total(weights), LEAST_PART);
}
