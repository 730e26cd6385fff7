// Lamps: which shine on a place of the ground, and how brightly. `systems/lamps/card.py` fills the texture.
#include "lib/frame.glsl"
#include "systems/lamps/card.py"

uniform usampler2D lamps;  // a column a lamp; then by cell where its list begins and how long it is; then the lists

const float DARKEST = 1e-9;  // radiance that divides another at least
const float NEAREST_LAMP = 0.1;  // distance from a lamp that counts at least [m]

// What a lamp sends to a place.
struct Shine {
    vec3 light;  // radiance of a white leaf that faces all ways
    vec3 from;   // the direction that it comes from
};

// Whether there are any, anywhere: else nobody need look. Programs that are made for none are told so by LAMPLESS.
bool any_lamps() {
#ifdef LAMPLESS
    return false;
#else
    return lamps_grid.w > 0.0;
#endif
}

float brightness(vec3 light) {
    return dot(light, vec3(1.0));
}

uint lamp_word(int row, int number) {
    return texelFetch(lamps, ivec2(number / 4 % LAMPS_ROW, row + number / (4 * LAMPS_ROW)), 0)[number % 4];
}

// The numbers in the lists from which and to which lamps are listed that may shine on a place.
ivec2 lamps_about(vec2 place) {
    vec2 at = floor((place - lamps_grid.xy) * lamps_grid.z);
    if (min(at.x, at.y) < 0.0 || max(at.x, at.y) >= lamps_grid.w)
        return ivec2(0);
    uint listed = lamp_word(CELLS_FROM, int(at.y * lamps_grid.w + at.x));
    return ivec2(int(listed >> 9)) + ivec2(0, int(listed & 511u));
}

// What the lamp of a number in the lists sends to a place: by the inverse square of the distance, as far as it reaches (Karis,
// Real Shading in Unreal Engine 4, 2013), and within its cone.
Shine lamp_at(int number, vec3 place) {
    int column = int(lamp_word(LISTS_FROM, number / 4) >> (8 * (number % 4))) & 255;
    vec4 stands = uintBitsToFloat(texelFetch(lamps, ivec2(column, 0), 0));
    vec4 shines = uintBitsToFloat(texelFetch(lamps, ivec2(column, 1), 0));
    vec4 aims = uintBitsToFloat(texelFetch(lamps, ivec2(column, 2), 0));
    vec3 way = stands.xyz - place;
    float far = dot(way, way), part = far * stands.w, window = max(1.0 - part * part, 0.0);
    vec3 from = way * inversesqrt(max(far, 1e-9));
    float within = clamp(aims.w - shines.w * dot(aims.xyz, from), 0.0, 1.0);
    return Shine(shines.rgb * (window * window * within * within / max(far, NEAREST_LAMP * NEAREST_LAMP)), from);
}
