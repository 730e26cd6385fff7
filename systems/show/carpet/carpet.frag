// The carpet: what is seen of its grass, and of the ground between. With EDGED, grass ends or has been cut there.
#define PIXELS_ASK
#include "lib/light.glsl"
#include "systems/show/carpet/within.glsl"
#include "systems/show/carpet/litter.glsl"

// With many kinds, pixels work out themselves what FEW kinds bring along: carpet.vert says what is what.
#if KINDS > 4
#define FEW
#else
#define FEW WITHIN in
#endif

#ifdef EDGED
#define BROUGHT
#define OF_SOIL
#define OF_SLOPE WITHIN in
vec3 place;
in vec3 over;
WITHIN in float lies_over;
WITHIN in float raises;
WITHIN in float hung;
#else
#define BROUGHT WITHIN in
in vec3 place;
#define OF_SOIL FEW
#define OF_SLOPE FEW
#endif

WITHIN in float mesh_share;
OF_SLOPE vec2 rise;
WITHIN in float curvature;
WITHIN in float lowered;
WITHIN in float rim_path;
BROUGHT float tall;
BROUGHT float leaf_area;
BROUGHT ByKind met;
BROUGHT vec3 soil_seen;
WITHIN in mat4 lit;
#ifdef HEADS
BROUGHT ByKind riper;
#endif
FEW float stands;
FEW float strips_before;
FEW float sways;
FEW vec2 slow;
OF_SOIL float elevation;
OF_SOIL vec3 sunlit;
OF_SOIL vec3 skylit;
OF_SOIL float soil_way;
OF_SOIL float soil_through;
OF_SOIL vec3 lush;

out vec4 pixel;

uniform int part;         // what is drawn: 0, all of it; 1, where it covers at least half a pixel; 2, the rest

#include "systems/show/carpet/shown.glsl"
#ifdef TRODDEN
#include "systems/show/carpet/trodden.glsl"
#endif
#ifdef EDGED
#include "systems/show/carpet/edged.glsl"
#include "systems/show/carpet/met.glsl"
#endif

ByKind grown;  // how densely each kind grows there

#if KINDS > 4 || defined(EDGED)
// What lies on the ground is of the kinds that grow there, up to where they end.
void work_out_soil() {
    Lie lies = lie_at(place.xz);
    lush = understorey_of(lies, grown);
#ifndef EDGED
    if (!anything_is_cut() && !any_casters())
        return;
#endif
    Soil soil = soil_lit(place, lies, grown, 1.0 - haze_at(place));
#ifdef EDGED
    soil_seen = soil.seen;
#endif
    sunlit = soil.sunlit;
    skylit = soil.skylit;
    soil_way = soil.way;
    soil_through = soil.through;
}
#endif

void work_out(float slope) {
#if KINDS > 4 || defined(EDGED)
    work_out_soil();
#endif
#if KINDS > 4
    strips_before = 1.0;
    slow = slow_seen(leaf_place(place, slope, tall, leaf_area), slope, tall);
    vec2 message = message_at(place.xz);
    stands = lodged(message);
    sways = sways_by(areas(grown), message);
#endif
}

// The light on what is met, and how that is bent: as the mesh has it, or as it is trodden.
Canopy canopy_here(Sight sight) {
    Canopy canopy = Canopy(unbundled(lit), told_beside(lit), vec2(0.0));
#ifdef EDGED
    canopy.light.leaves = vec2(0.0);
    for (int kind = 0; kind < KINDS; kind++)
        canopy.light.leaves += OF(met, kind) / max(total(met), TINY) * leaves_over(grown, kind);
#endif
#ifdef TRODDEN
    if (trodden_at(place.xz))
        canopy = trodden(canopy, met, place, sight.slope, sight.on_level, leaf_place(place, sight.slope, tall, leaf_area));
#endif
    return canopy;
}

// What the carpet shows: of grass and of the ground between, as much as there is of each, as of blades in front of it; and how
// much more leaves are met of plants that stand out of it. `cover` is how much of it is grass.
vec4 carpet_seen(Sight sight, float left, vec3 below, out float cover) {
    vec2 shown_at = image_place(place.xz, sight.heading, lowered, sight.slope);
    Patch own = patch_at(shown_at, sways, stands);
    Canopy canopy = canopy_here(sight);
    own.blown.xy += canopy.sways;
    vec2 among = vec2(1.0);
    if (min(sight.share, 1.0 - strips_before) < 1.0) {  // by pixel: between corners it bends too much
        float on_strips = strips_met(place.xz, max(sight.slope, TINY), mesh_share, tall, stands).y;
        among = among_strips(on_strips, sight.on_level, mesh_share, stands, leaf_area);
    }
    float deep = deepest(sight.slope, curvature, tall * stands), stubble = 1.0;
    ByKind area = all_kinds(0.0);
    if (anything_is_cut()) {
        area = areas(grown);
        stubble -= comes_through(weighed(area, leaves_left(left)) / max(sight.slope, LOWEST));
    }
#ifndef HEADS
    canopy.bent.yz *= higher(sight.on_level, leaf_area);
#endif
    float shallow = shallower(deep, sight.on_level, sight.share, curvature, stands, leaf_area);
    vec4 sent = any_lamps() ? lamps_seen(sight) : vec4(0.0);
    View view = View(canopy.light, canopy.bent, among, shallow, left, stubble, area, sent, stretch(slow));
#if KINDS > 4 || defined(EDGED)
    elevation = elevation_seen(sight.on_level, leaf_area);
#endif
    Reading read = reading(own, sight, shown_at, tall, elevation);
    float taller, grain = grain_of(read, sight, tall, stands, own.blown.z);
    vec4 sum = kinds_seen(own, read, sight, grain, view, taller);
    // Who sees past grass over a crest sees no ground there, but the grass behind. A game's own ground may lie lower.
    float ground = over_hosts > 0.0 ? 1.0 + HOSTS_OFF / (ENDS.x * max(tall, LOWEST_GRASS)) : 1.0;
    float ends = smoothstep(ENDS.x * sight.share * ground, ENDS.y * sight.share * ground, deep);
    sum *= among.x * mix(1.0 / max(sum.a, LEAST_COVER), 1.0, ends);
    cover = min(sum.a, 1.0);
    return vec4(sum.rgb + below * (1.0 - cover), standing_out(taller, sight.share));
}

// How many leaves lines of sight meet over an outline, that of a crest or of a rim, where taller plants stand out so.
vec4 met_behind(float slope) {
    return rim_path < NO_RIM ? vec4(RIM * leaf_area * rim_path * rim_path) : met_over(slope, curvature, tall, stands, leaf_area, pixel_height(place));
}

float stands_out(float taller) {
    return rim_path < NO_RIM ? sqrt(taller) : taller;
}

// Where the ground ends with the terrain, so does the grass: how much of what a line of sight would meet it does.
float before_rim(float slope) {
    vec2 way = heading_to(place.xz), rim = abs(mix(mesh_low, mesh_high, step(0.0, way)) - place.xz);
    float on = min(rim.x / max(abs(way.x), TINY), rim.y / max(abs(way.y), TINY)), leaves = leaf_area / max(slope, LOWEST);
    float met = 1.0 - comes_through(leaf_area * on / max(mesh_share * tall, LOWEST_GRASS));
    return min(met / max(1.0 - comes_through(leaves), TINY), 1.0);
}

// How much of what is seen there is carpet's.
float shares_here() {
    return mesh_share > 0.0 ? share_at(ivec2(floor(place.xz * patches_a_metre))) : 0.0;
}

#ifdef EDGED
// Where the line of sight comes to grass, from the mesh on, is the place of the pixel; how much that hides of what is behind.
float comes_to_grass() {
    Way way = way_from(over, lies_over, raises, viewing_slope(rise, over), curvature);
    bool aside;
    float at = enters(way, aside);
    if (hung > 0.0 && at <= 0.0)  // it stands as high on both sides: the tile before shows it
        at = -1.0;
    place = farther(over, max(at, 0.0));
    grown = grows_at(place.xz);
    float left = left_here(place.xz);
    tall = carpet_high(grown, left);
    leaf_area = weighed(grown, areas(leaves_left(left)));
    return at < 0.0 ? 0.0 : hidden_behind(way, at, aside, areas(grown), left);
}

// How much of each kind is met there.
void meet(float slope, float left) {
    ByKind ripe;
    float on_level = max(level_slope(max(slope, 0.0), curvature, mesh_share, tall, stands), FLATTEST);
    met = kinds_met(grown, on_level, left, left_by_strips(1.0 - strips_before, mesh_share), ripe);
    met = shared_out(met, grown, on_level);
#ifdef HEADS
    riper = ripe;
#endif
}
#endif

// Show what is seen there, where a line of sight has this slope and the carpet this share, and return whether anything is: of what is
// behind, grass hides `hidden` of what outlines say. To the next pixel it is so far (x, z) [m], and so far on the ground between.
bool show(float slope, float ahead, float left, float share, float hidden, vec2 dx, vec2 dy, vec3 ground, vec2 soil_dx, vec2 soil_dy) {
    vec3 pigment = pigment_lying(ground.xz, soil_dx, soil_dy, comes_through(leaf_area / max(slope, LOWEST)), lush, left);
    vec3 soil_light = soil_between(Soil(soil_seen, sunlit, skylit, soil_way, soil_through), ground, left);
    vec3 color = shown_of(soil_light * pigment * pigment + lit[2].rgb);
    float cover = 0.0;
    if (over_hosts > 0.0)
        color = vec3(0.0);  // the game's ground is seen there
    float top = slope + mesh_share * ahead, hides = min(share / SHOWN_FROM, 1.0);
    vec4 met_there = met_behind(top);
    float covered = 1.0 - hides * comes_through(met_there.w * stands_out(standing_out(TALLER, 1.0)));  // at most
    // It writes its depth: where strips still stand on the patch, the thin edge of an outline would hide them.
    if (covered < max(part == 1 ? HALF : NOTHING, STANDING * (1.0 - share)))
        return false;
#ifdef EDGED
    vec3 before = over_hosts > 0.0 ? before_hosts(place, mesh_share * tall, slope) : place;
    gl_FragDepth = gl_FragCoord.z + deeper(before, over);
#endif
    if (share > 0.0) {
        slope = rim_path < NO_RIM ? slope : slope_below(slope, curvature, pixel_height(place));
        float on_level = level_slope(slope, curvature, share, tall, stands);
        Sight sight = Sight(heading_to(place.xz), slope, on_level, smoothstep(ABOVE.x, ABOVE.y, slope), share, dx, dy);
        vec4 seen = carpet_seen(sight, left, color, cover);
        color = seen.rgb;
        if (met_there.x < ENOUGH)
            covered = mix(1.0, outline_cover(met_there * stands_out(seen.a)), hides);
    }
    covered *= hidden;
    if (mesh_high.x < EVERYWHERE)
        covered *= before_rim(slope);
    pixel = vec4(color, over_hosts > 0.0 ? cover : 1.0) * covered;
    return true;
}

void main() {
#ifndef EDGED
    vec2 dx = dFdx(place.xz), dy = dFdy(place.xz);
    if (KINDS > 4 || anything_is_cut())
        grown = grows_at(place.xz);
#if KINDS > 4
    rise = rise_at(place.xz);
#endif
    float slope = viewing_slope(rise, place), left = left_seen(place.xz), ahead = rises_ahead(place.xz, tall), share = shares_here();
    work_out(slope);
    vec3 ground = met_at(0.0, slope);
    bool shown = show(slope, ahead, left, share, 1.0, dx, dy, ground, dFdx(ground.xz), dFdy(ground.xz));
#else
    vec2 dx = dFdx(over.xz), dy = dFdy(over.xz);
    float hidden = comes_to_grass(), left = left_here(place.xz), share = shares_here();
    float slope = viewing_slope(rise, place);
    vec3 ground = met_at(0.0, slope);
    vec2 soil_dx = dFdx(ground.xz), soil_dy = dFdy(ground.xz);
    bool shown = false;
    // Of the tiles' pixels, most meet no grass. They are not discarded at once: in loops behind that, Mesa asks at each turn.
    if (hidden >= NOTHING && share > 0.0) {
        work_out(slope);
        meet(slope, left);
        shown = show(slope, 0.0, left, share, hidden, dx, dy, ground, soil_dx, soil_dy);
    }
#endif
    if (!shown || over_hosts > 0.0 && pixel.a < NOTHING || part != 0 && pixel.a < HALF == (part == 1))
        discard;
}
