// The ground between plants: its pigment, and what has fallen or grows low on it.
#include "lib/surface.glsl"

const float LITTER_MEAN = 255.0 / float(LITTER_ONE);  // what stands for ground as bright as its mean
const float FALLEN_TIPPED = 0.3;  // how much of the colour of tips what has fallen has, of a kind that shows it as grass does
const float LITTER = 0.75;  // how much of the ground under dense grass is covered by what has fallen
const float LITTER_FROM = 4.0;  // where low leaves cover less than a part of it, what has fallen does so, too: with none, the ground is bare
const float BLACKEST = 0.02;  // pigment that counts at least, for what is told of another by it
const float COARSEST = 16.0;  // level at which a texture is its mean, or its last

// What lies on the ground where grass stands, and the ground; white where a game has a ground of its own, whose pigment pixels
// bring. Programs that are made for none are told so by PLAIN.
vec3 soil_pigment(Lie lies, ByKind grows) {
#ifndef PLAIN
    if (earth_side != 0.0)
        return vec3(1.0);
#endif
    ByKind tipped;
    float covers = 0.0;
    for (int kind = 0; kind < KINDS; kind++) {
        OF(tipped, kind) = FALLEN_TIPPED * kinds[kind].bloom * kinds[kind].bloom;
        covers += OF(grows, kind) * min(OF(understorey, kind) * LITTER_FROM, 1.0);
    }
    return mix(soil, low_pigment(grows, tipped), LITTER * min(covers, 1.0)) * stretch(lies.slow);
}

// The pigment of the understorey's leaves, of that of the ground between; 1 where there are none.
vec3 understorey_of(Lie lies, ByKind grows) {
    vec3 between = soil_pigment(lies, grows);
    ByKind tipped;
    for (int group = 0; group < GROUPS; group++) {
        grows[group] *= understorey[group];
        tipped[group] = undertone[group];
    }
    vec3 leaves = low_pigment(grows, tipped) * stretch(lies.slow);
    return mix(vec3(1.0), leaves / max(between, BLACKEST), min(total(grows), 1.0));
}

// The pigment of what lies there, of that of the ground between low leaves: `lying` from `repeating`.
vec3 lying_pigment(vec2 lying, vec3 lush) {
    return lying.x * LITTER_MEAN * mix(vec3(1.0), lush, lying.y);
}

#ifndef PLAIN
uniform sampler2D earth;  // a game's own ground

// Where that has a place: it comes again, or is laid over the terrain.
vec2 on_earth(vec2 place) {
    return earth_side > 0.0 ? place / earth_side : on_map(place);
}

// The pigment that a texel of it stands for.
vec3 earth_pigment(vec4 texel) {
    return pow(max(texel.rgb, 0.0), vec3(earth_power));
}
#endif

const float SOIL_SENDS = 1.3;  // what bare ground sends of the sun's light from straight above, of what a leaf that faces all ways does

// The light on it, under a leaf area [of the ground's].
Light light_on_soil(vec3 place, Lie lies, float leaves) {
    Light light = light_at(place, Sender(FACE, vec2(0.0), lies.normal, SOIL_SENDS), lies.high, sun_seen(place, lies.past));
    light.leaves = vec2(leaves, 0.0);
    return light;
}

// The soil without what lies on it.
Surface soil_at(Lie lies, ByKind grows) {
    return Surface(soil_pigment(lies, grows), 0.0, 0.0);
}

// That in its light, under a leaf area [of the ground's].
vec3 soil_light(vec3 place, Lie lies, ByKind grows, float leaves) {
    return shade(soil_at(lies, grows), light_on_soil(place, lies, leaves));
}
