// Pigments of leaves: roots of albedos, so that what lies between two of them looks as if it did.
#include "lib/sown.glsl"

const vec2 STRETCHES = vec2(0.16, 0.14);  // how much the two slow noises change a pigment: all of it, and from fresh to dry
const vec3 DRIER = vec3(1.0, 0.1, -0.9);  // what the second changes of red, green and blue

// Drier and fresher stretches, as a factor of the pigment.
vec3 stretch(vec2 slow) {
    return 1.0 + STRETCHES.x * slow.x + STRETCHES.y * slow.y * DRIER;
}

// The pigment of a kind's blades at a part of their length.
vec3 pigment_at(int kind, float part) {
    return mix(kinds[kind].root, kinds[kind].tip, part);
}

// The same where so much of it is of the colour of a head's eye.
vec3 pigment_at(int kind, float part, float eyed) {
#ifdef EYED
    return pigment_at(kind, part) + eyed * (kinds[kind].eye_pigment - kinds[kind].tip);
#else
    return pigment_at(kind, part);
#endif
}

// Whether heads of a kind have an eye, or will have once it has become what it is to be.
bool has_eyes(int kind, bool comes) {
    float eyed = kinds[kind].eyed;
    return comes ? eyed >= 2.0 : mod(eyed, 2.0) >= 1.0;
}

// What that changes by where a face has its normal, whose azimuth twice has this cosine and sine.
vec3 grain_at(int kind, vec2 twice) {
    return 1.0 + kinds[kind].grain_c * twice.x + kinds[kind].grain_s * twice.y;
}

// Cosine and sine of twice an angle, of those of the angle.
vec2 doubled(vec2 angle) {
    return vec2(angle.x * angle.x - angle.y * angle.y, 2.0 * angle.x * angle.y);
}

// Mean cosine of twice the azimuth from the eye of blades that face all ways, as they are seen: a third by their breadth
// alone, and more, as broad ones hide narrow ones. Measured on slopes and level ground, with and without wind.
const float FACING = 0.43;

// Mean cosine and sine of twice the azimuth that blades face of those that a line of sight meets, where they lean along
// `lean` and face all ways. Of upright blades those are seen most that face the eye; of blades that lean aside, as much
// others as they are seen from above.
vec2 faces_seen(int kind, vec3 lean, vec3 ray) {
    vec2 across = cross(lean, ray).xz;
    float lies = OF(lying, kind) * lean.y * ray.y, all = dot(across, across);
    return FACING / max(all + lies * lies, LEAST_SQUARE) * vec2(across.y * across.y - across.x * across.x, -2.0 * across.x * across.y);
}

// A mean of what kinds look like near the ground, where each has so much of its tip's colour.
vec3 low_pigment(ByKind weights, ByKind tipped) {
    vec3 low = vec3(0.0);
    for (int kind = 0; kind < KINDS; kind++)
        low += OF(weights, kind) * pigment_at(kind, OF(tipped, kind));
    return low / max(total(weights), LEAST_PART);
}
