// Display colour of the grass of all kinds at a pixel of the carpet.
#include "lib/light.glsl"
#include "systems/show/carpet/among.glsl"
#include "systems/show/carpet/outline.glsl"
#include "systems/show/carpet/stubble.glsl"
#include "systems/show/carpet/texel.glsl"
#ifdef HEADS
const float DARKER = 0.5;  // degree to which the pigment of heads, which are no darker deep down, follows that of leaves
const float LEAST_USUAL = 0.02;  // least mean coverage of heads that divides
#endif

const float STUBBLE = 1.5;  // unevenness of stubble, relative to that of the grass

// What a pixel has in common for the grass of all kinds.
struct View {
    Light light;
    vec3 bent;         // from bent_change: additional leaves, factors of place and height
    vec2 among;        // from among_strips: factors of opacity and height
    float shallow;     // from depth_factor
    float cut_height;  // height to which it is cut [m]
    float stubble;     // opacity of what is left where it is cut
    ByKind area;       // leaf area index of each kind, where anything is cut
    vec4 lamps;        // from lamps_at
    vec3 fresh;        // factor of the pigment for drier and fresher stretches
};

// Change the place and height of a texel among strips, over a crest and in the wind.
void shift_leaves(int kind, inout Texel texel, View view) {
#ifdef HEADS
    // Leaves are darker deep down, heads are not.
    texel.place *= OF(bears, kind) > 0.0 ? mix(1.0, view.among.y, DARKER) : view.among.y;
#else
    texel.place *= view.among.y;
#endif
    texel.height *= view.among.y;
    texel.place = (1.0 - (1.0 - texel.place) * view.shallow) * view.bent.y;
    texel.height = (1.0 - (1.0 - texel.height) * view.shallow) * view.bent.z * OF(tops, kind);
}

// Change a texel and its light where the kind is cut: as if the same grass were compressed.
void apply_cut(int kind, inout Texel texel, inout Light light, View view, float usual_height) {
    float part = min(view.cut_height / max(OF(crown, kind), LOWEST_GRASS), 1.0);
    float uneven = 1.0 + STUBBLE * (texel.height / max(usual_height, LEAST_TEXEL) - 1.0);
    texel.covers = mix(min(view.stubble * uneven, 1.0), texel.covers, part);
    texel.place *= part;
    texel.height *= part;
    light = light_when_cut(view.cut_height, light, kind, view.area);
}

// The point of the line of sight through the pixel that is `height` [m] over the ground.
vec3 sight_at_height(float height, float slope) {
    float on = (mesh_share * tall - height) / max(slope, LOWEST);
    return moved_along(place, heading_to(place.xz) * clamp(on, -FARTHEST_SEEN, FARTHEST_SEEN));
}

// Light of lamps on the leaves that are seen, as from lamps_at, computed for the kind that is met most.
vec4 lamps_seen(Sight sight) {
    int kind = 0;
    for (int other = 1; other < KINDS; other++)
        kind = OF(met, other) > OF(met, kind) ? other : kind;
    vec3 there = leaf_place(place, sight.slope, tall, leaf_area);
    vec2 bend = bending(kind, near_message_at(place.xz));
    there.y -= sight.share * tall;
    vec3 ray = vec3(sight.heading, (there.y - eye.y) / max(distance(there.xz, eye.xz), TINY)).xzy;
    vec3 turned = turned_pigment(kind, lean_direction(bend), ray);
    vec4 sent = lamps_at(there, Reflector(kind, bend, lie_at(there.xz).normal, 1.0));
    sent.rgb *= turned * turned * (1.0 - haze_opacity(place));
    return sent;
}

// Premultiplied display colour and coverage of a kind; `taller` is that of Texel.
vec4 kind_seen(int kind, Patch grass_patch, Reading read, Sight sight, float grain, View view, out float taller) {
#ifdef HEADS
    if (OF(bears, kind) > 0.0)
        read.level += head_levels(read.across * patch_side, sight.slope);
#endif
    Texel texel = texel_of(kind, grass_patch, read, sight.on_level, grain);
    Light light = view.light;
    float usual_height = texel.height / (1.0 + texel.taller) * OF(tops, kind);
    taller = texel.taller;
    shift_leaves(kind, texel, view);
    if (has_casters())
        light = shadowed(light, casters_visibility_near(sight_at_height(texel.height * OF(crown, kind), sight.slope)), 1.0);
    if (any_lamps())
        light = with_lamps(light, view.lamps);
    float bent = max(1.0 - (1.0 - texel.covers) * transmittance(view.bent.x), 0.0);
#ifdef HEADS
    float ripe = figure_at(riper, kind);
    texel.place += ripe * (ripe > 0.0 ? 1.0 - texel.place : texel.place);
    // Scattered plants have all of their coverage where they stand, and none between.
    texel.covers = OF(bears, kind) > 0.0 ? texel.covers / max(texel.mean_cover, LEAST_USUAL) : bent;
#else
    texel.covers = bent;
#endif
    if (anything_is_cut() && is_mown(view.cut_height))
        apply_cut(kind, texel, light, view, usual_height);
    vec3 face_tint = azimuth_tint(kind, doubled_angle(sight.heading) * texel.cos_double);
    vec3 pigment = pigment_at(kind, texel.place, texel.place * texel.eyed) * view.fresh * face_tint;
    return texel.covers * vec4(tone_mapped(shade(leaf_surface(pigment, texel.height), light)), 1.0);
}

// Premultiplied display colour and coverage of all kinds, and their mean `taller`.
vec4 kinds_seen(Patch grass_patch, Reading read, Sight sight, float grain, View view, out float taller) {
    vec4 sum = vec4(0.0);
    float sum_taller = 0.0, kind_taller;
    int kind = next_kind(met, LEAST_MET, 0);
    if (kind < KINDS) do {
        float part = figure_at(met, kind);
        sum += part * kind_seen(kind, grass_patch, read, sight, grain, view, kind_taller);
        sum_taller += part * kind_taller;
        kind = next_kind(met, LEAST_MET, kind + 1);
    } while (kind < KINDS);
    taller = sum_taller / max(total(met), LEAST_TEXEL);
#ifdef HEADS
    sum /= max(sum.a, 1.0);
#endif
    return sum;
}
