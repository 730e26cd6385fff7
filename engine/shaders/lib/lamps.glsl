// Lamps: those that shine on a place of the ground, and their light there.
#include "lib/listed.glsl"

const float DARKEST = 1e-9;  // least radiance that anything is divided by
const float NEAREST_LAMP = 0.1;  // least distance from a lamp [m]

// The light of a lamp at a place.
struct Incoming {
    vec3 radiance;   // of a white leaf that faces all ways
    vec3 direction;  // towards the lamp
};

// Whether any lamp shines. Programs for scenes without lamps are compiled with LAMPLESS.
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

// The light at a place of the lamp with an index in the lists: by the inverse square of the distance, windowed to its reach (Karis,
// Real Shading in Unreal Engine 4, 2013), and within its cone.
Incoming lamp_at(int index, vec3 place) {
    mat3x4 lamp = listed_at(0, index);
    vec4 position = lamp[0], intensity = lamp[1], cone = lamp[2];
    vec3 to_lamp = position.xyz - place;
    float square = dot(to_lamp, to_lamp), part = square * position.w, window = max(1.0 - part * part, 0.0);
    vec3 direction = to_lamp * inversesqrt(max(square, LEAST_SQUARE));
    float inside = clamp(cone.w - intensity.w * dot(cone.xyz, direction), 0.0, 1.0);
    return Incoming(intensity.rgb * (window * window * inside * inside / max(square, NEAREST_LAMP * NEAREST_LAMP)), direction);
}
