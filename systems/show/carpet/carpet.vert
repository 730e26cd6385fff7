// The carpet: what varies little over a few pixels is computed at the vertices of the mesh. With EDGED, where grass ends or has been cut,
// pixels compute themselves what is PER_VERTEX otherwise.
#define PIXELS_ASK  // pools of light and shadows are smaller than the mesh
#define SPLINES  // of the wind, where leaves are lit
#include "lib/light.glsl"
#include "systems/show/carpet/lifted.glsl"
#include "systems/show/carpet/met.glsl"
#include "systems/show/carpet/reading.glsl"
#include "systems/show/carpet/floor.glsl"

#define PASSED out
#include "systems/show/carpet/carpet.glsl"

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
    Lie lies = lie_at(there.xz);
    Canopy canopy = canopy_lit(met, slope, on, there, lies, messages);
#ifndef HEADS  // among plants in flower, grass is as bright as in its images
    canopy.bent.y *= tip_ratio(met, densities, on);
#endif
    slow_noise = lies.slow;
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
