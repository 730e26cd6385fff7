// The carpet: what is the same over a few pixels is made out at the corners of the mesh. With EDGED, grass ends or has been
// cut there: pixels make out themselves what is BROUGHT along otherwise.
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

// No more than 60 numbers are sure to come through: with many kinds, pixels work out themselves what FEW kinds bring along.
#if KINDS > 4
#define FEW
#else
#define FEW WITHIN out
#endif

#ifdef EDGED
#define BROUGHT
#define OF_SOIL
#define OF_SLOPE WITHIN out
vec3 place;
out vec3 over;       // place on the mesh, which is raised to the carpet of whole grass,
WITHIN out float lies_over;      // how high that is over the ground [m],
WITHIN out float raises;      // and of how high the carpet is on level ground
WITHIN out float hung;        // how far it hangs down there from the border of its tile, of how high that lies
#else
#define BROUGHT WITHIN out
out vec3 place;
#define OF_SOIL FEW
#define OF_SLOPE FEW
#endif

WITHIN out float mesh_share;    // how much of what is seen is carpet's
OF_SLOPE vec2 rise;  // of the ground, along x and z
WITHIN out float curvature;     // how fast the rise falls off along the line of sight [1/m]
WITHIN out float rim_path;      // what it meets that passes over a rim, as past_rim has it
BROUGHT float tall;     // height of the carpet [m]
BROUGHT float leaf_area;    // leaf area seen from the side, of the ground's area
BROUGHT ByKind met;     // by kind: how much of what a line of sight meets
BROUGHT vec3 soil_seen;  // radiance of the soil, without haze
WITHIN out mat4 lit;        // the light on leaves of the kinds that are met; beside it, how what is met changes as the wind bends them
#ifdef HEADS
BROUGHT ByKind riper;   // by kind: how much more of its heads than an image shows; all the others at 1, none at -1
#endif
FEW float stands;         // how high the grass stands, of its height at rest
FEW float strips_before;  // how much strips show of what lines of sight come through above the carpet
#ifdef COARSE
WITHIN out vec2 blown;           // how far leaves are moved [m]
WITHIN out float on_level;       // slope on level ground of a line of sight that goes as far through the grass
WITHIN out float on_strips;      // root of the leaf area on strips above it, of the grass's: that falls off more evenly
WITHIN out vec3 soil_shaded;     // the soil where nothing is seen of the sun, as it is shown, for litter whose brightness is 1
WITHIN out vec4 lies_at;         // places along blades and heights at the top of the grass, and by how much less they are at its bottom
#else
WITHIN out float lowered;        // how much lower the carpet lies than where no strips stand [m]
FEW float sways;          // how far leaves sway, of the wind's message [m]
FEW vec2 slow;            // slow noises of the pigment, where leaves are seen
#endif
OF_SOIL float elevation;  // of elevation_seen
#ifndef COARSE
OF_SOIL vec3 sunlit;      // radiance of the soil without any grass: of the sun's light,
OF_SOIL vec3 skylit;      // and of the sky's
OF_SOIL float soil_way;   // how many leaves the sun's light meets
OF_SOIL float soil_through; // how much of it comes through the grass
OF_SOIL vec3 lush;        // pigment of the understorey, of that of the ground between
#endif

const float UNEVENNESS = 0.4;  // of the grass's height
const vec4 UNEVEN_WAVES = vec4(5.3, 4.7, 0.2, 0.7);  // [1/m], along x, along z, and across the latter; phase

// How much higher or lower the carpet lies where it gives way to strips, of the grass's height. A row of strips that lies as
// the carpet does would come out of it all at once; so it does here and there.
float uneven(vec2 at) {
    return UNEVENNESS * sin(UNEVEN_WAVES.x * at.x + UNEVEN_WAVES.w) * sin(UNEVEN_WAVES.y * at.y + UNEVEN_WAVES.z * at.x);
}

// How much higher it lies along an outline, where the tallest kinds are seen alone, and over half a pixel of which it shows less [m].
float stands_out(Laid laid, vec3 place) {
#ifdef EDGED
    return 0.0;
#else
    float tops = (laid.tops - 1.0) * laid.tall * max(outline, 1.0);
    return laid.rim_path < NO_RIM || over_hosts > 0.0 ? 0.0 : laid.share * laid.crest_weight * (tops + 0.5 * pixel_height(place));
#endif
}

void hand_on(Laid laid) {
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
// Where leaves are met that stand among strips, over a crest and in the wind, of where images show them.
void see_among(float slope, vec2 bent) {
    on_strips = sqrt(strips_met(place.xz, max(slope, TINY), mesh_share, tall, stands).y);
#ifndef HEADS
    bent *= higher(on_level, leaf_area);
#endif
    lies_at = vec4(bent, bent * shallower(deepest(slope, curvature, tall * stands), on_level, mesh_share, curvature, stands, leaf_area));
}

// As much more of each kind as grass hides, seen at this slope, than images do in the mean. Heads stand scattered, and hide nothing.
ByKind filled_up(ByKind covers) {
    int low = min(int(elevation), SLOPES - 2);
    for (int kind = 0; kind < KINDS; kind++) {
#ifdef HEADS
        if (OF(bears, kind) > 0.0)
            continue;
#endif
        int layer = int(OF(first, kind)) + low * HEADINGS;
        float lower = layer_mean(images, layer, stock.z).a, steeper = layer_mean(images, layer + HEADINGS, stock.z).a;
        OF(covers, kind) *= filled(lower, steeper, low, on_level, mix(lower, steeper, elevation - float(low)));
    }
    return covers;
}
#endif

// The light on what is met.
void light_up(float slope, float on, ByKind grows, vec2 message) {
    vec3 there = leaf_place(place, slope, tall, leaf_area);
    vec2 messages[KINDS];
    for (int kind = 0; kind < KINDS; kind++)
        messages[kind] = message;
    Canopy canopy = canopy_lit(met, slope, on, there, lie_at(there.xz), messages);
#ifndef HEADS  // among plants in flower, grass is as bright as its images show it
    canopy.bent.y *= tips_met(met, grows, on);
#endif
#ifdef COARSE
    vec3 fresh = stretch(slow_seen(there, slope, tall));
    canopy.light.sun *= fresh * fresh;  // a factor of the pigment, whose square is what is sent
    canopy.light.sky *= fresh * fresh;
    see_among(slope, canopy.bent.yz);
    canopy.bent.x = comes_through(canopy.bent.x);
#else
    slow = slow_seen(there, slope, tall);
#endif
    lit = bundled(veiled(canopy.light, place), canopy.bent);
}

#ifndef EDGED
// The soil that is seen between, and what lies on it.
void light_soil(vec3 ground, Laid laid) {
    Lie lies = lie_at(ground.xz);
    ByKind grows = grown_at(ground.xz, laid);
    Soil soil = soil_lit(ground, lies, grows, 1.0 - haze_at(place));
#ifdef COARSE
    vec2 usual = textureLod(repeating, vec2(0.5), COARSEST).gb;
    vec3 pigment = lying_pigment(usual, understorey_of(lies, grows));
    vec3 skylit = soil.skylit * comes_through(OPEN_SKY * total(areas(grows)));
    soil_seen = shown_of(soil.seen * pigment * pigment + lit[2].rgb) / max(usual.x, LEAST_TEXEL);
    soil_shaded = shown_of(skylit * pigment * pigment + lit[2].rgb) / max(usual.x, LEAST_TEXEL);
#else
    soil_seen = soil.seen;
    sunlit = soil.sunlit;
    skylit = soil.skylit;
    soil_way = soil.way;
    soil_through = soil.through;
    lush = understorey_of(lies, grows);
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
    place.y += moved + stands_out(laid, place);
    laid.lowered -= moved;
#ifdef EDGED
    over = place;
    lies_over = place.y - laid.ground;
    raises = lies_over / max(laid.tall, LOWEST_GRASS);
    hung = skirt_drop(over.xz);
    over.y -= hung * lies_over;
#endif
    hand_on(laid);
    float slope = viewing_slope(rise, place), from_above = max(slope, FLATTEST);
    strips_before = strips_met(place.xz, from_above, mesh_share, tall, stands).x;
#ifndef COARSE
    float on_level;
#endif
    on_level = max(level_slope(max(slope, 0.0), curvature, mesh_share, tall, stands), FLATTEST);
    ByKind ripe;
    met = shared_out(kinds_met(laid.grows, on_level, laid.left, left_by_strips(1.0 - strips_before, mesh_share), ripe), laid.grows, on_level);
#ifdef HEADS
    riper = ripe;
#endif
    elevation = elevation_seen(on_level, leaf_area);
#ifdef COARSE
    blown = sways_by(met, laid.message) * laid.message;
#else
    sways = sways_by(met, laid.message);
#endif
    light_up(slope, on_level, laid.grows, laid.message);
#ifdef COARSE
    met = filled_up(met);
#endif
#ifndef EDGED
    light_soil(seen_behind(place, laid.ground, from_above), laid);
#endif
#ifdef EDGED
    lies_over *= 1.0 - hung;
    gl_Position = clip * vec4(over, 1.0);
#else
    gl_Position = clip * vec4(place, 1.0);
#endif
#ifndef EDGED  // where pixels make out how far off grass is
    if (over_hosts > 0.0) {
        vec4 before = clip * vec4(before_hosts(place, place.y - laid.ground, slope), 1.0);
        gl_Position.z = before.z * gl_Position.w / before.w;
    }
#endif
}
