// The carpet: its grass, and the ground between. With EDGED, grass ends or has been cut there.
#define PIXELS_ASK
#if KINDS <= 4 && !defined(EDGED)
#define SUNWARD_BY_VERTEX
#endif
#include "lib/light.glsl"
#include "systems/show/carpet/litter.glsl"

#define PASSED in
#include "systems/show/carpet/carpet.glsl"

out vec4 pixel;

uniform int part;  // pixels to draw: 0, all; 1, those with a coverage of at least half; 2, the others

#include "systems/show/carpet/shown.glsl"
#ifdef TRODDEN
#include "systems/show/carpet/trodden.glsl"
#endif
#ifdef EDGED
#include "systems/show/carpet/edged.glsl"
#include "systems/show/carpet/met.glsl"
#endif

const float MOST_RADIANCE = 65504.0;  // the largest number of 16 bits: framebuffers of radiance have these

ByKind densities_here;  // density of each kind at the place

#if KINDS > 4 || defined(EDGED)
// The understorey is of the kinds that grow there, up to where they end.
void evaluate_soil() {
    Lie lies = lie_at(place.xz);
    lush = understorey_pigment(lies, densities_here);
#ifndef EDGED
    if (!anything_is_cut() && !has_casters())
        return;
#endif
    Soil soil = soil_lit(place, lies, densities_here, 1.0 - haze_opacity(place));
#ifdef EDGED
    soil_seen = soil.seen;
#endif
    sunlit = soil.sunlit;
    skylit = soil.skylit;
    soil_extinction = soil.extinction;
    soil_through = soil.through;
}
#endif

void evaluate(float slope) {
#if KINDS > 4 || defined(EDGED)
    evaluate_soil();
#endif
#if KINDS > 4
    strips_before = 1.0;
    slow_noise = slow_noise_at(leaf_place(place, slope, tall, leaf_area).xz);
    vec2 message = near_message_at(place.xz);
    stands = lodged(message);
    sway = sway_of(leaf_areas(densities_here), message);
#endif
}

// Light on the leaves that are met, and their bending: from the vertices, changed where grass is trodden.
Canopy canopy_here(Sight sight) {
    Canopy canopy = Canopy(unpack_light(lit), packed_extra(lit), vec2(0.0));
#ifdef EDGED
    canopy.light.leaves = vec2(0.0);
    for (int kind = 0; kind < KINDS; kind++)
        canopy.light.leaves += OF(met, kind) / max(total(met), TINY) * leaf_area_split(densities_here, kind);
#endif
#ifdef TRODDEN
    if (trodden_at(place.xz))
        canopy = trodden(canopy, met, place, sight.slope, sight.on_level, leaf_place(place, sight.slope, tall, leaf_area));
#endif
    return canopy;
}

// Display colour of the carpet, grass over the ground `below`, and the spike_factor of its plants. `cover` is the coverage of its grass.
vec4 carpet_seen(Sight sight, float cut_height, vec3 below, out float cover) {
    vec2 shown_at = image_place(place.xz, sight.heading, lowered, sight.slope);
    Patch grass_patch = patch_at(shown_at, sway, stands);
    Canopy canopy = canopy_here(sight);
    grass_patch.blown.xy += canopy.sway;
    vec2 among = vec2(1.0);
    if (min(sight.share, 1.0 - strips_before) < 1.0) {  // by pixel, as it is too curved between vertices
        float on_strips = strips_met(place.xz, max(sight.slope, TINY), mesh_share, tall, stands).y;
        among = among_strips(on_strips, sight.on_level, mesh_share, stands, leaf_area);
    }
    float deep = deepest(sight.slope, curvature, tall * stands), stubble = 1.0;
    ByKind area = all_kinds(0.0);
    if (anything_is_cut()) {
        area = leaf_areas(densities_here);
        stubble -= transmittance(weighted_sum(area, leaf_area_left(cut_height)) / max(sight.slope, LOWEST));
    }
#ifndef HEADS
    canopy.bent.yz *= height_factor(sight.on_level, leaf_area);
#endif
    float shallow = depth_factor(deep, sight.on_level, sight.share, curvature, stands, leaf_area);
    vec4 sent = any_lamps() ? lamps_seen(sight) : vec4(0.0);
    View view = View(canopy.light, canopy.bent, among, shallow, cut_height, stubble, area, sent, dryness_tint(slow_noise));
#if KINDS > 4 || defined(EDGED)
    elevation = elevation_index(sight.on_level, leaf_area);
#endif
    Reading read = reading(grass_patch, sight, shown_at, tall, elevation);
    float taller, grain = grain_scale(read, sight, tall, stands, grass_patch.blown.z);
    vec4 sum = kinds_seen(grass_patch, read, sight, grain, view, taller);
    // Past grass over a crest one sees the grass behind, and no ground. A game's own ground may lie lower.
    float ground = over_hosts > 0.0 ? 1.0 + HOSTS_OFF / (ENDS.x * max(tall, LOWEST_GRASS)) : 1.0;
    float ends = smoothstep(ENDS.x * sight.share * ground, ENDS.y * sight.share * ground, deep);
    sum *= among.x * mix(1.0 / max(sum.a, LEAST_COVER), 1.0, ends);
    cover = min(sum.a, 1.0);
    return vec4(sum.rgb + below * (1.0 - cover), spike_factor(taller, sight.share));
}

// Optical depths of the lines of sight of a pixel over an outline, that of a crest or of a rim.
vec4 outline_leaves(float slope) {
    if (rim_path < NO_RIM)
        return vec4(RIM * leaf_area * rim_path * rim_path);
    return leaves_over_crest(slope, curvature, tall, stands, leaf_area, pixel_height(place));
}

// Factor of those optical depths for taller plants.
float spikes_over_edge(float taller) {
    return rim_path < NO_RIM ? sqrt(taller) : taller;
}

// Opacity of the grass at the edge of ground that ends with the terrain, relative to grass that goes on.
float edge_coverage(float slope) {
    vec2 way = heading_to(place.xz), rim = abs(mix(mesh_low, mesh_high, step(0.0, way)) - place.xz);
    float on = min(rim.x / max(abs(way.x), TINY), rim.y / max(abs(way.y), TINY)), leaves = leaf_area / max(slope, LOWEST);
    float met = 1.0 - transmittance(leaf_area * on / max(mesh_share * tall, LOWEST_GRASS));
    return min(met / max(1.0 - transmittance(leaves), TINY), 1.0);
}

// The carpet's share of the grass, in [0, 1].
float share_here() {
    return mesh_share > 0.0 ? share_at(ivec2(floor(place.xz * patches_per_metre))) : 0.0;
}

#ifdef EDGED
// Set the place of the pixel, where the line of sight enters grass, and the grass there; return its opacity.
float find_grass() {
    Way way = way_from(mesh_place, mesh_height, mesh_lift, viewing_slope(rise, mesh_place), curvature);
    bool aside;
    float at = entry_distance(way, aside);
    if (skirt > 0.0 && at <= 0.0)  // grass is as high on both sides: the tile before draws it
        at = -1.0;
    place = moved_along(mesh_place, max(at, 0.0));
    densities_here = density_at(place.xz);
    float cut_height = cut_height_here(place.xz);
    tall = carpet_height(densities_here, cut_height);
    leaf_area = weighted_sum(densities_here, leaf_areas(leaf_area_left(cut_height)));
    return at < 0.0 ? 0.0 : hidden_behind(way, at, aside, leaf_areas(densities_here), cut_height);
}

// Set the weights of the images of kinds.
void evaluate_kinds(float slope, float cut_height) {
    ByKind ripe;
    float on_level = max(level_slope(max(slope, 0.0), curvature, mesh_share, tall, stands), FLATTEST);
    met = kinds_met(densities_here, on_level, cut_height, height_past_strips(1.0 - strips_before, mesh_share), ripe);
    met = image_weights(met, densities_here, on_level);
#ifdef HEADS
    riper = ripe;
#endif
}
#endif

// Set the pixel's colour, and return whether it shows anything. `hidden` is a factor of its coverage. `dx` and `dy` lead to the next
// pixels across and up (x, z) [m], `soil_dx` and `soil_dy` do so on the ground between.
bool draw_pixel(float slope, float ahead, float cut_height, float share, float hidden, vec2 dx, vec2 dy, vec3 ground, vec2 soil_dx,
                vec2 soil_dy) {
    vec3 pigment = ground_pigment(ground.xz, soil_dx, soil_dy, transmittance(leaf_area / max(slope, LOWEST)), lush, cut_height);
    vec3 soil_light = soil_radiance(Soil(soil_seen, sunlit, skylit, soil_extinction, soil_through), ground, cut_height);
    vec3 color = tone_mapped(soil_light * pigment * pigment + lit[2].rgb);
    float cover = 0.0;
    if (over_hosts > 0.0)
        color = vec3(0.0);  // the game's ground shows there
    float top = slope + mesh_share * ahead, hides = min(share / SHOWN_FROM, 1.0);
    vec4 met_there = outline_leaves(top);
    float covered = 1.0 - hides * transmittance(met_there.w * spikes_over_edge(spike_factor(TALLER, 1.0)));  // at most
    // The pixel writes depth: where strips still stand on the patch, the thin edge of an outline would hide them.
    if (covered < max(part == 1 ? HALF : NOTHING, STANDING * (1.0 - share)))
        return false;
#ifdef EDGED
    vec3 before = over_hosts > 0.0 ? before_hosts(place, mesh_share * tall, slope, mesh_share) : place;
    gl_FragDepth = gl_FragCoord.z + depth_beyond(before, mesh_place);
#endif
    if (share > 0.0) {
        slope = rim_path < NO_RIM ? slope : slope_below(slope, curvature, pixel_height(place));
        float on_level = level_slope(slope, curvature, share, tall, stands);
        Sight sight = Sight(heading_to(place.xz), slope, on_level, smoothstep(ABOVE.x, ABOVE.y, slope), share, dx, dy);
        vec4 seen = carpet_seen(sight, cut_height, color, cover);
        color = seen.rgb;
        if (met_there.x < ENOUGH)
            covered = mix(1.0, outline_cover(met_there * spikes_over_edge(seen.a)), hides);
    }
    covered *= hidden;
    if (mesh_high.x < EVERYWHERE)
        covered *= edge_coverage(slope);
    pixel = vec4(color, over_hosts > 0.0 ? cover : 1.0) * covered;
    return true;
}

void main() {
#ifndef EDGED
    vec2 dx = dFdx(place.xz), dy = dFdy(place.xz);
    if (KINDS > 4 || anything_is_cut())
        densities_here = density_at(place.xz);
#if KINDS > 4
    rise = gradient_at(place.xz);
#endif
    float slope = viewing_slope(rise, place), cut_height = cut_height_seen(place.xz), share = share_here();
    float ahead = carpet_rise_ahead(place.xz, tall);
    evaluate(slope);
    vec3 ground = sight_at_height(0.0, slope);
    bool shown = draw_pixel(slope, ahead, cut_height, share, 1.0, dx, dy, ground, dFdx(ground.xz), dFdy(ground.xz));
#else
    vec2 dx = dFdx(mesh_place.xz), dy = dFdy(mesh_place.xz);
    float hidden = find_grass(), cut_height = cut_height_here(place.xz), share = share_here();
    float slope = viewing_slope(rise, place);
    vec3 ground = sight_at_height(0.0, slope);
    vec2 soil_dx = dFdx(ground.xz), soil_dy = dFdy(ground.xz);
    bool shown = false;
    // Most pixels of these tiles meet no grass. They are discarded only at the end: after a discard, Mesa tests in each turn of a loop.
    if (hidden >= NOTHING && share > 0.0) {
        evaluate(slope);
        evaluate_kinds(slope, cut_height);
        shown = draw_pixel(slope, 0.0, cut_height, share, hidden, dx, dy, ground, soil_dx, soil_dy);
    }
#endif
    // With several samples a pixel, one beyond a crest has a place that is extrapolated, at worst to infinity.
    bool is_number = dot(pixel.rgb, vec3(1.0)) < MOST_RADIANCE;
    if (!shown || !is_number || over_hosts > 0.0 && pixel.a < NOTHING || part != 0 && pixel.a < HALF == (part == 1))
        discard;
}
