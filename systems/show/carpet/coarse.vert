// The carpet of cheaper presets, without lamps: all that does not vary from leaf to leaf is computed at the vertices of the mesh.
#define PIXELS_ASK  // shadow maps are finer than the mesh
#define SPLINES  // of the wind, where leaves are lit
#include "lib/light.glsl"
#include "lib/tone.glsl"
#include "systems/show/carpet/among.glsl"
#include "systems/show/carpet/floor.glsl"
#include "systems/show/carpet/lifted.glsl"
#include "systems/show/carpet/met.glsl"
#include "systems/show/carpet/texel.glsl"
#define PASSED out
#include "systems/show/carpet/coarse.glsl"

float on_level;  // from level_slope

const float LOWER = 0.5;  // height of the lower one of two leaves whose light is computed, as a part of what images show
const float BEHIND_NOTHING = 9.0 * log(2.0);  // optical depth from which on 8 bits hold nothing of what is behind
const float PER_PATH = 1.0 / 1.5;  // exponent of the path over a crest, by its optical depth

// Set the varyings of the grass's height over a crest and over a rim.
void set_outline(Laid laid, float slope) {
    float high = max(laid.tall * laid.stands, LOWEST_GRASS), pixel = pixel_height(place);
    facing = slope;
    crest = 2.0 * max(laid.curvature, LEAST_CURVATURE);
    crest_deep = crest * high;
    crest_leaves = CREST * laid.leaf_area / (high * high) + BARE_LEAVES * max(1.0 - laid.tall / (2.0 * LOWEST_GRASS), 0.0);
    in_pixel = pixel * LINES - outline_raise(laid.curvature, pixel);
    float leaves = crest_leaves * inversesqrt(crest) * transmittance(0.5 * SPIKES * TALLER);  // among plants lower than the mean
    float opaque_path = pow(BEHIND_NOTHING / max(leaves, TINY), PER_PATH);
    outlined_to = crest * max(ENDS.y * high, opaque_path - in_pixel.x);
    rim_path = laid.rim_path;
    rim_leaves = RIM * laid.leaf_area;
}

// Set `past_strips` and `places`, the change of images among strips, over a crest and in the wind; return the place along blades and the
// height of the lower leaf, then those of the leaf on top. `on_strips` is the leaf area on strips above, as a fraction of the grass's.
vec4 set_places(Laid laid, float slope, float on_strips, vec2 bent) {
    vec2 among = on_strips > 0.0 ? among_strips(on_strips, on_level, laid.share, laid.stands, laid.leaf_area) : vec2(1.0);
    float deep = deepest(slope, laid.curvature, laid.tall * laid.stands);
    deep = depth_factor(deep, on_level, laid.share, laid.curvature, laid.stands, laid.leaf_area);
#ifndef HEADS
    bent *= height_factor(on_level, laid.leaf_area);
#endif
    past_strips = among.x;
    places = vec4(bent * (1.0 - deep), bent * (deep * among.y));
    return vec4(places.xy + LOWER * places.zw, places.xy + places.zw);
}

// Mean factor on pigments by the azimuths of the leaves that are met.
vec3 azimuth_tint_met() {
    vec3 tint = vec3(0.0);
    for (int kind = 0; kind < KINDS; kind++)
        tint += OF(met, kind) * azimuth_tint(kind, FACING * doubled_angle(heading_to(place.xz)));
    return tint / max(total(met), TINY);
}

// Set the varyings of light, which is linear in the height of leaves between two of them, as set_places returns them.
void set_light(Light light, vec4 leaves) {
    vec3 haze = light.haze, albedo = mean_pigment(met, all_kinds(leaves.x));
    albedo = max(albedo * albedo, TINY);
    float gloss = light.gloss * transmittance(light.extinction * leaf_area_above(leaves.w, light.leaves));
    light.haze = vec3(0.0);
    light.gloss = 0.0;
    vec3 low = shade(leaf_surface(sqrt(albedo), leaves.y), light) / albedo, high = shade(leaf_surface(sqrt(albedo), leaves.w), light) / albedo;
    // The root of radiance is nearly linear in the pigment: exactly so without air, and always exact for the mean pigment.
    vec3 air = haze + sunlight * gloss, low_root = sqrt(max(low * albedo + air, TINY)), high_root = sqrt(max(high * albedo + air, TINY));
    air_root = air * (0.5 / low_root + 0.5 / high_root);
    vec3 whole = azimuth_tint_met() * inversesqrt(albedo), upper = (high_root - air_root) * whole, lower = (low_root - air_root) * whole;
    root_rise = (upper - lower) / max(leaves.w - leaves.y, TINY);
    lit_root = lower - root_rise * leaves.y;
    light.sun = vec3(0.0);
    in_shade.x = brightness(shade(leaf_surface(sqrt(albedo), leaves.y), light) / albedo) / max(brightness(low), DARKEST);
}

// Light the leaves that are met; return the haze before them.
vec3 light_leaves(Laid laid, float slope, float on_strips) {
    vec3 there = leaf_place(place, slope, laid.tall, laid.leaf_area);
    vec2 messages[KINDS];
    for (int kind = 0; kind < KINDS; kind++)
        messages[kind] = laid.message;
    Lie lies = lie_at(there.xz);
    Canopy canopy = canopy_lit(met, slope, on_level, there, lies, messages);
#ifndef HEADS  // among plants in flower, grass is as bright as in its images
    canopy.bent.y *= tip_ratio(met, laid.densities, on_level);
#endif
    vec3 fresh = dryness_tint(lies.slow);
    canopy.light.sun *= fresh * fresh;  // a factor of the pigment, whose square is the albedo
    canopy.light.sky *= fresh * fresh;
    bent_through = transmittance(canopy.bent.x);
    Light light = hazed(canopy.light, place);
    set_light(light, set_places(laid, slope, on_strips, canopy.bent.yz));
    return light.haze;
}

// Light the soil that is seen between, and what lies on it.
void light_soil(vec3 ground, vec3 haze) {
    Lie lies = lie_at(ground.xz);
    ByKind densities = density_at(ground.xz);
    Soil soil = soil_lit(ground, lies, densities, 1.0 - haze_opacity(place));
    vec2 usual = textureLod(repeating, vec2(0.5), COARSEST).gb;
    vec3 pigment = litter_pigment(usual, understorey_pigment(lies, densities));
    vec3 skylit = soil.skylit * transmittance(OPEN_SKY * total(leaf_areas(densities)));
    soil_seen = tone_mapped(soil.seen * pigment * pigment + haze) / max(usual.x, LEAST_TEXEL);
    vec3 shaded = tone_mapped(skylit * pigment * pigment + haze) / max(usual.x, LEAST_TEXEL);
    in_shade.y = brightness(shaded) / max(brightness(soil_seen), DARKEST);
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

// Set mip levels, gain of contrast and lengthening at which images and litter are read, at this viewing slope.
void set_sharpness(float tall, float slope) {
    float across = pixel_height(place), size = float(textureSize(images, 0).x);
    level = log2(max(across * patches_per_metre, THINNEST_PIXEL) * (SHARP * size));
    float stripe = across * sqrt(1.0 + 1.0 / (slope * slope));
    litter_level = log2(stripe * float(textureSize(repeating, 0).x) / LITTER_SIDE) - LITTER_SHARPER;
    float steep = smoothstep(STEEP.x, STEEP.y, on_level), filtered = clamp(level + FILTERED - log2(SHARP), 0.0, 1.0);
    stretch = vec2(on_level, 1.0) * (1.0 - smoothstep(ROOTS_SEEN.x, ROOTS_SEEN.y, on_level));
    float far = inversesqrt(1.0 + across / (FEATURE * max(tall, LOWEST_GRASS)));
    grain = CONTRAST * mix(far * mix(1.0, GRAIN, filtered), mix(1.0, GRAIN_ABOVE.x, filtered), steep);
}

void main() {
    place = on_ground(on_mesh());
    Laid laid = lifted_on(place);
    mesh_share = laid.share;
    float slope = viewing_slope(laid.rise, place), from_above = max(slope, FLATTEST);
    vec2 before = strips_met(place.xz, from_above, laid.share, laid.tall, laid.stands);
    on_level = max(level_slope(max(slope, 0.0), laid.curvature, laid.share, laid.tall, laid.stands), FLATTEST);
    ByKind ripe;
    met = kinds_met(laid.densities, on_level, laid.cut_height, height_past_strips(1.0 - before.x, laid.share), ripe);
    met = image_weights(met, laid.densities, on_level);
    light_soil(seen_behind(place, laid.ground, from_above), light_leaves(laid, slope, before.y));
    // Last comes what is simple: the fewer numbers a vertex has to keep meanwhile, the more of them a card computes at a time.
#ifdef HEADS
    riper = ripe;
#endif
    elevation = elevation_index(on_level, laid.leaf_area);
    blown = sway_of(met, laid.message) * laid.message;
    leaning = image_shear(vec3(1.0, 0.0, laid.stands), on_level, laid.tall).x;
    met = filled_covers(met);
    set_sharpness(laid.tall, from_above);
    set_outline(laid, slope);
    gl_Position = clip * vec4(place, 1.0);
}
