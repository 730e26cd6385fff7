// How densely each kind grows, and what leaf area that is.
#include "lib/lie.glsl"

uniform sampler2DArray density;  // over the terrain, four kinds in each layer: how densely each grows

const float LOWEST_CROWN = 0.01;  // height of a canopy that counts at least [m]

// How densely each kind grows at a place.
ByKind grows_at(vec2 place) {
    vec2 at = on_map(place);
    ByKind grows;
    for (int group = 0; group < GROUPS; group++)
        grows[group] = textureLod(density, vec3(at, float(group)), 0.0);
    return grows;
}

// How densely one does.
float grows_at(vec2 place, int kind) {
    return textureLod(density, vec3(on_map(place), float(GROUP(kind))), 0.0)[IN_GROUP(kind)];
}

// The leaf area of each kind, of the ground's.
ByKind areas(ByKind grows) {
    for (int group = 0; group < GROUPS; group++)
        grows[group] *= leaf[group];
    return grows;
}
