// The ground between plants: bare soil, litter and the understorey.
#include "lib/surface.glsl"

const float LITTER_MEAN = 255.0 / float(LITTER_ONE);  // scale of the texture's brightness, whose mean is 1 then
const float LITTER_SHARPER = 0.4;  // mip levels by which the texture is read finer, as filtering reduces contrast
const float FALLEN_TIPPED = 0.3;  // share of the tips' pigment in a kind's litter, for a bloom of 1
const float LITTER = 0.75;  // coverage of the ground by litter under dense grass
const float LITTER_FROM = 4.0;  // litter's coverage rises with this times the understorey's: without one, the ground is bare
const float BLACKEST = 0.02;  // least pigment that another is divided by
const float COARSEST = 16.0;  // a mip level beyond the last of any texture: its mean

// Pigment of soil and litter; white on a game's own ground, whose pigment pixels multiply in. Programs for scenes without one are
// compiled with PLAIN.
vec3 soil_pigment(Lie lies, ByKind densities) {
#ifndef PLAIN
    if (earth_side != 0.0)
        return vec3(1.0);
#endif
    ByKind tipped;
    float covers = 0.0;
    for (int kind = 0; kind < KINDS; kind++) {
        OF(tipped, kind) = FALLEN_TIPPED * kinds[kind].bloom * kinds[kind].bloom;
        covers += OF(densities, kind) * min(OF(understorey, kind) * LITTER_FROM, 1.0);
    }
    return mix(soil, mean_pigment(densities, tipped), LITTER * min(covers, 1.0)) * dryness_tint(lies.slow);
}

// Pigment of the understorey's leaves relative to the soil's; 1 where there are none.
vec3 understorey_pigment(Lie lies, ByKind densities) {
    vec3 between = soil_pigment(lies, densities);
    ByKind tipped;
    for (int group = 0; group < GROUPS; group++) {
        densities[group] *= understorey[group];
        tipped[group] = undertone[group];
    }
    vec3 leaves = mean_pigment(densities, tipped) * dryness_tint(lies.slow);
    return mix(vec3(1.0), leaves / max(between, BLACKEST), min(total(densities), 1.0));
}

// Factor of litter and understorey on the soil's pigment: `lying` is read from `repeating`, `lush` is understorey_pigment's.
vec3 litter_pigment(vec2 lying, vec3 lush) {
    return lying.x * LITTER_MEAN * mix(vec3(1.0), lush, lying.y);
}

#ifndef PLAIN
uniform sampler2D earth;  // texture of a game's own ground

// Texture coordinates of a place on it: it repeats, or is stretched over the terrain.
vec2 earth_uv(vec2 place) {
    return earth_side > 0.0 ? place / earth_side : on_terrain_map(place);
}

// Pigment of one of its texels.
vec3 earth_pigment(vec4 texel) {
    return pow(max(texel.rgb, 0.0), vec3(earth_power));
}
#endif

const float SOIL_SENDS = 1.3;  // reflection of bare ground for light from straight above, relative to leaves that face all ways

// The light on the soil under a leaf area index.
Light light_on_soil(vec3 place, Lie lies, float leaves) {
    Light light = light_at(place, Reflector(FACE, vec2(0.0), lies.normal, SOIL_SENDS), lies.sun_sine, sun_visibility(place, lies.visibility));
    light.leaves = vec2(leaves, 0.0);
    return light;
}

// The soil as a surface, without litter's pattern.
Surface soil_surface(Lie lies, ByKind densities) {
    return Surface(soil_pigment(lies, densities), 0.0, 0.0);
}

// Radiance of the soil under a leaf area index.
vec3 soil_radiance(vec3 place, Lie lies, ByKind densities, float leaves) {
    return shade(soil_surface(lies, densities), light_on_soil(place, lies, leaves));
}
