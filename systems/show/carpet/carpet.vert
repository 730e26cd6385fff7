// The carpet: what varies little over a few pixels is computed at the vertices of the mesh. With EDGED, where grass ends or has been cut,
// pixels compute themselves what is PER_VERTEX otherwise.
#define PIXELS_ASK  // pools of light and shadows are smaller than the mesh
#include "lib/light.glsl"
#include "systems/show/carpet/within.glsl"
#include "systems/show/carpet/lifted.glsl"
#include "systems/show/carpet/met.glsl"
#include "systems/show/carpet/reading.glsl"
#include "systems/show/carpet/floor.glsl"

// OpenGL guarantees only 60 varying components: with many kinds, pixels compute themselves what is a varying for FEW_KINDS.
#if KINDS > 4
#define FEW_KINDS
#else
#define FEW_KINDS WITHIN out
#endif

#ifdef EDGED
#define PER_VERTEX
#define OF_SOIL
#define OF_SLOPE WITHIN out
vec3 place;
out vec3 mesh_place;           // place on the mesh, which is as high as the carpet of uncut grass
WITHIN out float mesh_height;  // height of that over the ground [m]
WITHIN out float mesh_lift;    // the same, as a fraction of the carpet's height on level ground
WITHIN out float skirt;        // drop of the skirt below the border of its piece, as a fraction of the border's height
#else
#define PER_VERTEX WITHIN out
out vec3 place;
#define OF_SOIL FEW_KINDS
#define OF_SLOPE FEW_KINDS
#endif

WITHIN out float mesh_share;  // the carpet's share of the grass, in [0, 1]
OF_SLOPE vec2 rise;           // gradient of the ground along x and z [m/m]
WITHIN out float curvature;   // curvature of the ground along the line of sight [1/m]
WITHIN out float rim_path;    // from rim_path_at
PER_VERTEX float tall;        // height of the carpet [m]
PER_VERTEX float leaf_area;   // leaf area index, seen from the side
PER_VERTEX ByKind met;        // by kind: weight of its image
PER_VERTEX vec3 soil_seen;    // radiance of the soil, without haze
WITHIN out mat4 lit;          // light on the leaves that are met, and what their bending changes: from bundled
#ifdef HEADS
PER_VERTEX ByKind riper;  // by kind: excess of heads over its image, from kinds_met
#endif
FEW_KINDS float stands;         // height of the grass in the wind, as a fraction of that at rest
FEW_KINDS float strips_before;  // mean share of strips above the carpet, along the line of sight
WITHIN out float lowered;   // depth of the carpet below its height where no strips stand [m]
FEW_KINDS float sway;       // displacement of leaves per message of the wind [m]
FEW_KINDS vec2 slow_noise;  // slow noises of the pigment at the leaves that are seen
OF_SOIL float elevation;  // from elevation_index
OF_SOIL vec3 sunlit;            // radiance of the soil without any grass: from the sun
OF_SOIL vec3 skylit;            // and from the sky
OF_SOIL float soil_extinction;  // of sunlight: optical depth for each 1 of leaf area seen from the side
OF_SOIL float soil_through;     // transmittance of the grass for sunlight
OF_SOIL vec3 lush;              // pigment of the understorey, relative to that of the ground between
#if defined(TREES) && KINDS <= 4 && !defined(EDGED)
out vec3 sunward;  // from trees_sunward
#endif

void write_varyings(Laid laid) {
    mesh_share = laid.share;
    rise = laid.rise;
    curvature = laid.curvature;
    rim_path = laid.rim_path;
    lowered = laid.lowered;
    tall = laid.tall;
    leaf_area = laid.leaf_area;
    stands = laid.stands;
}

// Light the leaves that are met.
void light_leaves(float slope, float on, ByKind densities, vec2 message) {
    vec3 there = leaf_place(place, slope, tall, leaf_area);
    vec2 messages[KINDS];
    for (int kind = 0; kind < KINDS; kind++)
        messages[kind] = message;
    Canopy canopy = canopy_lit(met, slope, on, there, lie_at(there.xz), messages);
#ifndef HEADS  // among plants in flower, grass is as bright as in its images
    canopy.bent.y *= tip_ratio(met, densities, on);
#endif
    slow_noise = slow_noise_at(there, slope, tall);
    lit = pack_light(hazed(canopy.light, place), canopy.bent);
}

#ifndef EDGED
// Light the soil that is seen between, and what lies on it.
void light_soil(vec3 ground, Laid laid) {
    Lie lies = lie_at(ground.xz);
    ByKind densities = grown_at(ground.xz, laid);
    Soil soil = soil_lit(ground, lies, densities, 1.0 - haze_opacity(place));
    soil_seen = soil.seen;
    sunlit = soil.sunlit;
    skylit = soil.skylit;
    soil_extinction = soil.extinction;
    soil_through = soil.through;
    lush = understorey_pigment(lies, densities);
}
#endif

void main() {
#ifdef EDGED
    place = on_ground(on_mesh_at(skirt_top() + piece.xy));
#else
    place = on_ground(on_mesh());
#endif
    Laid laid = lifted_on(place);
#ifdef EDGED
    mesh_place = place;
    mesh_height = place.y - laid.ground;
    mesh_lift = mesh_height / max(laid.tall, LOWEST_GRASS);
    skirt = skirt_drop(mesh_place.xz);
    mesh_place.y -= skirt * mesh_height;
#endif
    write_varyings(laid);
    float slope = viewing_slope(rise, place), from_above = max(slope, FLATTEST);
    strips_before = strips_met(place.xz, from_above, mesh_share, tall, stands).x;
    float on_level = max(level_slope(max(slope, 0.0), curvature, mesh_share, tall, stands), FLATTEST);
    ByKind ripe;
    met = kinds_met(laid.densities, on_level, laid.cut_height, height_past_strips(1.0 - strips_before, mesh_share), ripe);
    met = image_weights(met, laid.densities, on_level);
#ifdef HEADS
    riper = ripe;
#endif
    elevation = elevation_index(on_level, leaf_area);
    sway = sway_of(met, laid.message);
    light_leaves(slope, on_level, laid.densities, laid.message);
#ifndef EDGED
    light_soil(seen_behind(place, laid.ground, from_above), laid);
#endif
#if defined(TREES) && KINDS <= 4 && !defined(EDGED)
    sunward = trees_sunward(place);
#endif
#ifdef EDGED
    mesh_height *= 1.0 - skirt;
    gl_Position = clip * vec4(mesh_place, 1.0);
#else
    gl_Position = clip * vec4(place, 1.0);
#endif
#ifndef EDGED  // there, pixels compute their depth
    if (over_hosts > 0.0) {
        vec4 before = clip * vec4(before_hosts(place, place.y - laid.ground, slope, laid.share), 1.0);
        gl_Position.z = before.z * gl_Position.w / before.w;
    }
#endif
}
