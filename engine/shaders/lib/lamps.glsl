// Lamps: which shine on a place of the ground, and how brightly.
#include "lib/listed.glsl"

const float DARKEST = 1e-9;  // radiance that divides another at least
const float NEAREST_LAMP = 0.1;  // distance from a lamp that counts at least [m]

// What a light sends to a place.
struct Shine {
    vec3 light;  // radiance of a white leaf that faces all ways
    vec3 from;   // the direction that it comes from
};

// Whether anything shines beside sun and sky: else nobody need look. Programs that are made for nothing such are told so by
// LAMPLESS.
bool any_lamps() {
#ifdef LAMPLESS
    return false;
#else
    return beside_sun > 0.0;
#endif
}

float brightness(vec3 light) {
    return dot(light, vec3(1.0));
}

// The numbers in the lists from which and to which lamps are listed that may shine on a place.
ivec2 lamps_about(vec2 place) {
    return listed_about(lamps_grid, 0, place);
}

// What the lamp of a number in the lists sends to a place: by the inverse square of the distance, as far as it reaches (Karis,
// Real Shading in Unreal Engine 4, 2013), and within its cone.
Shine lamp_at(int number, vec3 place) {
    mat3x4 told = listed_at(0, number);
    vec4 stands = told[0], shines = told[1], aims = told[2];
    vec3 way = stands.xyz - place;
    float far = dot(way, way), part = far * stands.w, window = max(1.0 - part * part, 0.0);
    vec3 from = way * inversesqrt(max(far, LEAST_SQUARE));
    float within = clamp(aims.w - shines.w * dot(aims.xyz, from), 0.0, 1.0);
    return Shine(shines.rgb * (window * window * within * within / max(far, NEAREST_LAMP * NEAREST_LAMP)), from);
}
