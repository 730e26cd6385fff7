// The carpet: what varies little over a few pixels is computed at the vertices of the mesh. With EDGED, where grass ends or has been cut,
// pixels compute themselves what is PER_VERTEX otherwise.
#define PIXELS_ASK  // pools of light and shadows are smaller than the mesh
#include "lib/light.glsl"
#include "systems/show/carpet/within.glsl"
#include "systems/show/carpet/laid.glsl"
#include "systems/show/carpet/met.glsl"
#include "systems/show/carpet/reading.glsl"
#include "systems/show/carpet/floor.glsl"
#ifdef COARSE
#include "lib/tone.glsl"
#include "systems/show/carpet/among.glsl"
#include "systems/show/carpet/texel.glsl"
#endif

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
#ifdef COARSE
WITHIN out vec2 blown;        // displacement of leaves [m]
WITHIN out float on_level;    // from level_slope
WITHIN out float on_strips;   // root of the leaf area on strips above it, as a fraction of the grass's: that is more linear
WITHIN out vec3 soil_shaded;  // display colour of shaded soil, for litter whose brightness is 1
WITHIN out vec4 leaf_range;   // place along blades and height at the top of the grass; their decrease down to its bottom
#else
WITHIN out float lowered;   // depth of the carpet below its height where no strips stand [m]
FEW_KINDS float sway;       // displacement of leaves per message of the wind [m]
FEW_KINDS vec2 slow_noise;  // slow noises of the pigment at the leaves that are seen
#endif
OF_SOIL float elevation;  // from elevation_index
#ifndef COARSE
OF_SOIL vec3 sunlit;            // radiance of the soil without any grass: from the sun
OF_SOIL vec3 skylit;            // and from the sky
OF_SOIL float soil_extinction;  // of sunlight: optical depth for each 1 of leaf area seen from the side
OF_SOIL float soil_through;     // transmittance of the grass for sunlight
OF_SOIL vec3 lush;              // pigment of the understorey, relative to that of the ground between
#endif

const float UNEVENNESS = 0.4;  // amplitude, as a fraction of the grass's height
const vec4 UNEVEN_WAVES = vec4(5.3, 4.7, 0.2, 0.7);  // [1/m], along x, along z, and across the latter; phase

// Unevenness of the carpet where it gives way to strips, as a fraction of the grass's height. Over an even carpet, a row of strips would
// come out all at once; so it does here and there.
float uneven(vec2 at) {
    return UNEVENNESS * sin(UNEVEN_WAVES.x * at.x + UNEVEN_WAVES.w) * sin(UNEVEN_WAVES.y * at.y + UNEVEN_WAVES.z * at.x);
}

// Raise of the carpet along an outline [m]: to the tops of the tallest kinds, and by half a pixel, in which coverage fades.
float outline_height(Laid laid, vec3 place) {
#ifdef EDGED
    return 0.0;
#else
    float tops = (laid.tops - 1.0) * laid.tall * max(outline, 1.0);
    return laid.rim_path < NO_RIM || over_hosts > 0.0 ? 0.0 : laid.share * laid.crest_weight * (tops + 0.5 * pixel_height(place));
#endif
}

void write_varyings(Laid laid) {
    mesh_share = laid.share;
    rise = laid.rise;
    curvature = laid.curvature;
    rim_path = laid.rim_path;
#ifndef COARSE
    lowered = laid.lowered;
#endif
    tall = laid.tall;
    leaf_area = laid.leaf_area;
    stands = laid.stands;
}

#ifdef COARSE
// Set leaf_range, by which places and heights of the images are changed over a crest and in the wind, and the leaf area on strips.
void set_leaf_range(float slope, vec2 bent) {
    on_strips = sqrt(strips_met(place.xz, max(slope, TINY), mesh_share, tall, stands).y);
#ifndef HEADS
    bent *= height_factor(on_level, leaf_area);
#endif
    float deep = deepest(slope, curvature, tall * stands);
    leaf_range = vec4(bent, bent * depth_factor(deep, on_level, mesh_share, curvature, stands, leaf_area));
}

// Weights of images, scaled up to the opacity of grass at this slope. Kinds with heads stand scattered, and stay as they are.
ByKind filled_covers(ByKind covers) {
    int low = min(int(elevation), SLOPES - 2);
    for (int kind = 0; kind < KINDS; kind++) {
#ifdef HEADS
        if (OF(bears, kind) > 0.0)
            continue;
#endif
        int layer = int(OF(first, kind)) + low * HEADINGS;
        float lower = layer_mean(images, layer, stock.z).a, steeper = layer_mean(images, layer + HEADINGS, stock.z).a;
        OF(covers, kind) *= opacity_ratio(lower, steeper, low, on_level, mix(lower, steeper, elevation - float(low)));
    }
    return covers;
}
#endif

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
#ifdef COARSE
    vec3 fresh = dryness_tint(slow_noise_at(there, slope, tall));
    canopy.light.sun *= fresh * fresh;  // a factor of the pigment, whose square is the albedo
    canopy.light.sky *= fresh * fresh;
    set_leaf_range(slope, canopy.bent.yz);
    canopy.bent.x = transmittance(canopy.bent.x);
#else
    slow_noise = slow_noise_at(there, slope, tall);
#endif
    lit = pack_light(hazed(canopy.light, place), canopy.bent);
}

#ifndef EDGED
// Light the soil that is seen between, and what lies on it.
void light_soil(vec3 ground, Laid laid) {
    Lie lies = lie_at(ground.xz);
    ByKind densities = grown_at(ground.xz, laid);
    Soil soil = soil_lit(ground, lies, densities, 1.0 - haze_opacity(place));
#ifdef COARSE
    vec2 usual = textureLod(repeating, vec2(0.5), COARSEST).gb;
    vec3 pigment = litter_pigment(usual, understorey_pigment(lies, densities));
    vec3 skylit = soil.skylit * transmittance(OPEN_SKY * total(leaf_areas(densities)));
    soil_seen = tone_mapped(soil.seen * pigment * pigment + lit[2].rgb) / max(usual.x, LEAST_TEXEL);
    soil_shaded = tone_mapped(skylit * pigment * pigment + lit[2].rgb) / max(usual.x, LEAST_TEXEL);
#else
    soil_seen = soil.seen;
    sunlit = soil.sunlit;
    skylit = soil.skylit;
    soil_extinction = soil.extinction;
    soil_through = soil.through;
    lush = understorey_pigment(lies, densities);
#endif
}
#endif

void main() {
#ifdef EDGED
    place = on_ground(on_mesh_at(skirt_top() + piece.xy));
#else
    place = on_ground(on_mesh());
#endif
    Laid laid = laid_on(place);
    float moved = laid.share * (1.0 - laid.share) * laid.tall * uneven(place.xz);
    place.y += moved + outline_height(laid, place);
    laid.lowered -= moved;
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
#ifndef COARSE
    float on_level;
#endif
    on_level = max(level_slope(max(slope, 0.0), curvature, mesh_share, tall, stands), FLATTEST);
    ByKind ripe;
    met = kinds_met(laid.densities, on_level, laid.cut_height, height_past_strips(1.0 - strips_before, mesh_share), ripe);
    met = image_weights(met, laid.densities, on_level);
#ifdef HEADS
    riper = ripe;
#endif
    elevation = elevation_index(on_level, leaf_area);
#ifdef COARSE
    blown = sway_of(met, laid.message) * laid.message;
#else
    sway = sway_of(met, laid.message);
#endif
    light_leaves(slope, on_level, laid.densities, laid.message);
#ifdef COARSE
    met = filled_covers(met);
#endif
#ifndef EDGED
    light_soil(seen_behind(place, laid.ground, from_above), laid);
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
