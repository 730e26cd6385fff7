// An opaque layer beneath the carpet, which the tips of outlines stand out from. It lies as deep in the grass as is seen into it.
#include "lib/light.glsl"
#include "systems/show/carpet/laid.glsl"
#include "systems/show/carpet/met.glsl"

const float SUNK = 2.5;  // optical depth of what a line of sight has met where nothing is seen through it
const float THROUGH_CREST = 1.6;  // the same over a crest, as the reference shows it
const float CUBE_ROOT = 0.667;  // over a crest, optical depth goes by the depth to the power of 3/2
const float LAIN = 0.9;  // how much deeper it lies along an outline where grass is bent: tips stand out there, too
const vec2 SINKS_IN = vec2(0.05, 1.0);  // how deep it lies at least, and at most, of the height of the grass
const vec2 BEHIND = vec2(0.01, 0.05);  // slopes at which ground falls away from the eye: hardly, and wholly
const float WITHIN = 0.25;  // how high the eye is over the layer from which on it is not within the grass [m]
const vec2 COARSE = vec2(10.0, 20.0);  // how far apart points of the mesh are where it is seen: far off, hills have few faces [m]
const float SHADED = 0.6;  // how far down what is seen stands, of how deep is seen into the grass
const float FLAT_SIGHT = 0.07;  // slope of a line of sight by which grass counts as sparse: a walker's over some 25 m
const float ON_TOP = 0.9;  // where it stands if nothing is seen into it, of the height of the grass

centroid out vec3 color;  // radiance
#ifdef EDGED
out vec3 over;   // place, where all grass is whole; with EDGED it ends there, or has been cut,
centroid out float lies_over;  // how high that is over the ground [m],
centroid out float raises;  // and of how high the carpet is on level ground
centroid out float slope; // of the line of sight to the ground
centroid out float curvature; // how fast the rise of the ground falls off along it [1/m]
#endif

// How deep it lies, of the height of the grass: as deep as is seen into it, from above and through a crest.
float sunk_by(Laid laid, vec3 place) {
    float leaf_area = max(laid.leaf_area, TINY), bulges = max(laid.curvature, 0.0);
    float sunk = sqrt(SUNK * max(laid.slope, 0.0) / leaf_area);
    float over_crest = laid.stands * pow(THROUGH_CREST * sqrt(2.0 * bulges * laid.tall * laid.stands) / (CREST * leaf_area), CUBE_ROOT);
    over_crest += LAIN * (1.0 - laid.stands) * min(bulges / CREST_CURVATURE, 1.0) * clamp(1.0 - laid.slope / BEHIND.y, 0.0, 1.0);
    float behind = clamp((-laid.slope - BEHIND.x) / (BEHIND.y - BEHIND.x), 0.0, 1.0);  // nobody sees it
    behind *= clamp((eye.y - place.y) / WITHIN, 0.0, 1.0);  // from within the grass, what stands around is seen
#ifdef MIRRORED
    behind *= 1.0 - smoothstep(COARSE.x, COARSE.y, grid_spacing);
#endif
    return max(clamp(max(sunk, over_crest), SINKS_IN.x, SINKS_IN.y), behind);
}

// How far down what is seen stands, of the height of the grass. Where flat lines of sight come through it, those that meet some
// of it do not meet tips alone.
float seen_down(float sunk, float leaf_area) {
    float flat_way = max(leaf_area, THINNEST) / FLAT_SIGHT;
    return mix(sunk, max(sunk, depth_met(flat_way)), comes_through(flat_way));
}

// The radiance of the grass that is seen there.
vec3 grass_seen(Laid laid, ByKind met, vec3 place, float sunk) {
    Lie lies = lie_at(place.xz);
    vec3 sum = vec3(0.0);
    for (int kind = 0; kind < KINDS; kind++) {
        Light light = light_on(kind, vec2(0.0), place, lies, laid.grows);
        float high = ON_TOP - SHADED * seen_down(sunk, laid.leaf_area);
        if (anything_is_cut()) {
            light = mown_to(laid.left, light, kind, areas(laid.grows));
            high *= min(laid.left / max(OF(crown, kind), LOWEST_GRASS), 1.0);
        }
        vec3 pigment = mix(pigment_at(kind, kinds[kind].bloom), pigment_at(kind, 0.0), 1.0 - high);
        sum += OF(met, kind) * shade(leaf_at(pigment * stretch(lies.slow), high), light);
    }
    return sum;
}

void main() {
    vec3 place = on_ground(on_mesh());
    Laid laid = laid_on(place);
    float sunk = sunk_by(laid, place);
    place.y -= laid.share * laid.tall * laid.trodden_height * sunk;
    if (laid.rim_path < NO_RIM)  // over a rim grass is seen through down to the ground
        place.y = laid.ground;
    float sight = viewing_slope(laid.rise, place), from_above = max(sight, FLATTEST);
#ifdef EDGED
    over = place;
    lies_over = place.y - laid.ground;
    raises = lies_over / max(laid.tall, LOWEST_GRASS);
    slope = sight;
    curvature = laid.curvature;
#endif
    float on_level = max(level_slope(max(sight, 0.0), laid.curvature, laid.share, laid.tall, laid.stands), FLATTEST);
    float came = strips_met(place.xz, from_above, laid.share, laid.tall, laid.stands).x;
    ByKind ripe, met = kinds_met(laid.grows, on_level, laid.left, left_by_strips(1.0 - came, laid.share), ripe);
    float part = min(total(laid.grows), 1.0) / max(total(met), THINNEST_LAYER);
    for (int group = 0; group < GROUPS; group++)
        met[group] *= part;

    vec3 ground = seen_behind(place, laid.ground, from_above);
    Lie lies = lie_at(ground.xz);
    ByKind grows = grown_at(ground.xz, laid);
    float leaves = weighed(areas(grows), leaves_left(laid.left));
    vec3 litter = lying_pigment(textureLod(repeating, vec2(0.5), COARSEST).gb, understorey_of(lies, grows));
#ifndef PLAIN
    if (earth_side != 0.0)
        litter = earth_pigment(textureLod(earth, on_earth(ground.xz), COARSEST));
#endif
    color = soil_light(ground, lies, grows, leaves) * litter * litter;
    // Where grass grows thinly or not at all, what lies beneath is the soil.
    color = mix(color, color * (1.0 - total(met)) + grass_seen(laid, met, place, sunk), laid.share);
    color = mix(color, haze_light(place), haze_at(place));
    gl_Position = clip * vec4(place, 1.0);
    gl_Position.z += farther_by(APART) * gl_Position.w;
}
