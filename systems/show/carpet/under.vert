// An opaque layer under the carpet, out of which the tips of outlines stand. It lies in the grass as deep as one can see.
#include "lib/light.glsl"
#include "systems/show/carpet/laid.glsl"
#include "systems/show/carpet/met.glsl"

const float SUNK = 2.5;  // optical depth at which nothing is seen through grass
const float THROUGH_CREST = 1.6;  // the same over a crest: matches the reference
const float CUBE_ROOT = 0.667;  // exponent over a crest, where optical depth goes by the depth to the power of 3/2
const float LAIN = 0.9;  // additional depth along an outline where grass is bent: tips stand out there, too
const vec2 SINKS_IN = vec2(0.05, 1.0);  // least and greatest depth, as fractions of the height of the grass
const vec2 BEHIND = vec2(0.01, 0.05);  // slopes at which ground begins to face away from the eye, and faces away
const float WITHIN = 0.25;  // height of the eye over the layer from which on it is outside of the grass [m]
const vec2 COARSE = vec2(10.0, 20.0);  // grid spacings from which on it may be seen, as hills have few faces far away [m]
const float SHADED = 0.6;  // depth of what is seen, as a fraction of the depth that can be seen
const float FLAT_SIGHT = 0.07;  // slope of a line of sight that tells sparse grass: a walker's over some 25 m
const float ON_TOP = 0.9;  // height of what is seen in opaque grass, as a fraction of the height of the grass

centroid out vec3 color;  // radiance
#ifdef EDGED
out vec3 mesh_place;             // place on the mesh, as high as uncut grass
centroid out float mesh_height;  // height of that over the ground [m]
centroid out float mesh_lift;    // the same, as a fraction of the carpet's height on level ground
centroid out float slope;        // slope of the line of sight to the ground [m/m]
centroid out float curvature;    // curvature of the ground along it [1/m]
#endif

// Depth of the layer, as a fraction of the height of the grass: as deep as one sees from above and through a crest.
float sink_depth(Laid laid, vec3 place) {
    float leaf_area = max(laid.leaf_area, TINY), bulges = max(laid.curvature, 0.0);
    float sunk = sqrt(SUNK * max(laid.slope, 0.0) / leaf_area);
    float over_crest = laid.stands * pow(THROUGH_CREST * sqrt(2.0 * bulges * laid.tall * laid.stands) / (CREST * leaf_area), CUBE_ROOT);
    over_crest += LAIN * (1.0 - laid.stands) * min(bulges / CREST_CURVATURE, 1.0) * clamp(1.0 - laid.slope / BEHIND.y, 0.0, 1.0);
    float behind = clamp((-laid.slope - BEHIND.x) / (BEHIND.y - BEHIND.x), 0.0, 1.0);  // cannot be seen
    behind *= clamp((eye.y - place.y) / WITHIN, 0.0, 1.0);  // seen from within the grass
#ifdef MIRRORED
    behind *= 1.0 - smoothstep(COARSE.x, COARSE.y, grid_spacing);
#endif
    return max(clamp(max(sunk, over_crest), SINKS_IN.x, SINKS_IN.y), behind);
}

// Depth of what is seen, as a fraction of the height of the grass. Where flat lines of sight come through sparse grass, those that meet
// some do not meet tips alone.
float visible_depth(float sunk, float leaf_area) {
    float flat_way = max(leaf_area, THINNEST) / FLAT_SIGHT;
    return mix(sunk, max(sunk, mean_depth_met(flat_way)), transmittance(flat_way));
}

// Radiance of the grass that is seen there.
vec3 grass_seen(Laid laid, ByKind met, vec3 place, float sunk) {
    Lie lies = lie_at(place.xz);
    vec3 sum = vec3(0.0);
    for (int kind = 0; kind < KINDS; kind++) {
        Light light = leaf_light(kind, vec2(0.0), place, lies, laid.densities);
        float high = ON_TOP - SHADED * visible_depth(sunk, laid.leaf_area);
        if (anything_is_cut()) {
            light = light_when_cut(laid.cut_height, light, kind, leaf_areas(laid.densities));
            high *= min(laid.cut_height / max(OF(crown, kind), LOWEST_GRASS), 1.0);
        }
        vec3 pigment = mix(pigment_at(kind, kinds[kind].bloom), pigment_at(kind, 0.0), 1.0 - high);
        sum += OF(met, kind) * shade(leaf_surface(pigment * dryness_tint(lies.slow), high), light);
    }
    return sum;
}

void main() {
    vec3 place = on_ground(on_mesh());
    Laid laid = laid_on(place);
    float sunk = sink_depth(laid, place);
    float below = laid.tall * laid.trodden_height * sunk;
#ifndef EDGED  // its own edge is hard: the carpet's fades above it
    below += laid.crest_weight * outline_fade(pixel_height(place));
#endif
    place.y -= laid.share * below;
    if (laid.rim_path < NO_RIM)  // over a rim grass is seen through down to the ground
        place.y = laid.ground;
    float sight = viewing_slope(laid.rise, place), from_above = max(sight, FLATTEST);
#ifdef EDGED
    mesh_place = place;
    mesh_height = place.y - laid.ground;
    mesh_lift = mesh_height / max(laid.tall, LOWEST_GRASS);
    slope = sight;
    curvature = laid.curvature;
#endif
    float on_level = max(level_slope(max(sight, 0.0), laid.curvature, laid.share, laid.tall, laid.stands), FLATTEST);
    float came = strips_met(place.xz, from_above, laid.share, laid.tall, laid.stands).x;
    ByKind ripe, met = kinds_met(laid.densities, on_level, laid.cut_height, height_past_strips(1.0 - came, laid.share), ripe);
    float part = min(total(laid.densities), 1.0) / max(total(met), THINNEST_LAYER);
    for (int group = 0; group < GROUPS; group++)
        met[group] *= part;

    vec3 ground = seen_behind(place, laid.ground, from_above);
    Lie lies = lie_at(ground.xz);
    ByKind densities = grown_at(ground.xz, laid);
    float leaves = weighted_sum(leaf_areas(densities), leaf_area_left(laid.cut_height));
    vec3 litter = litter_pigment(textureLod(repeating, vec2(0.5), COARSEST).gb, understorey_pigment(lies, densities));
#ifndef PLAIN
    if (earth_side != 0.0)
        litter = earth_pigment(textureLod(earth, earth_uv(ground.xz), COARSEST));
#endif
    color = soil_radiance(ground, lies, densities, leaves) * litter * litter;
    // Where grass is sparse or missing, the layer shows the soil.
    color = mix(color, color * (1.0 - total(met)) + grass_seen(laid, met, place, sunk), laid.share);
    color = mix(color, haze_radiance(place), haze_opacity(place));
    gl_Position = clip * vec4(place, 1.0);
    gl_Position.z += depth_offset(APART) * gl_Position.w;
}
