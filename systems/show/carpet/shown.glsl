// What the carpet shows at a pixel: the grass of all kinds that is met, and the ground between.
#include "lib/light.glsl"
#include "systems/show/carpet/among.glsl"
#include "systems/show/carpet/outline.glsl"
#include "systems/show/carpet/stubble.glsl"
#include "systems/show/carpet/texel.glsl"
#ifdef HEADS
const float DARKER = 0.5;  // how far heads, which are no darker deep down, follow the leaves that are
const float LEAST_USUAL = 0.02;  // mean coverage of heads that what is met of them is parted among at least
#endif

const float STUBBLE = 1.5;  // how unevenly stubble stands, for how unevenly the grass did

// How a pixel sees the grass of all kinds.
struct View {
    Light light;
    vec3 bent;      // how what is met changes as the wind bends it: leaves more, factors of place and height
    vec2 among;     // how much of it is seen among strips, and how high
    float shallow;  // how deep it is, of how deep it is on level ground
    float left;     // up to which height it is left to stand [m]
    float stubble;  // how much of the ground is hidden by what is left
    ByKind area;    // leaf area of each kind, of the ground's, where anything is cut
    vec4 lamps;     // what lamps send, of lamps_at
    vec3 fresh;     // drier and fresher stretches: a factor of the pigment
};

// Where leaves are met that stand among strips, over a crest and in the wind, of where images show them.
void place_leaves(int kind, inout Texel texel, View view) {
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

// What is left of a kind where it is cut is taken for the same grass pressed together.
void cut_down(int kind, inout Texel texel, inout Light light, View view, float usual_height) {
    float part = min(view.left / max(OF(crown, kind), LOWEST_GRASS), 1.0);
    float uneven = 1.0 + STUBBLE * (texel.height / max(usual_height, LEAST_TEXEL) - 1.0);
    texel.covers = mix(min(view.stubble * uneven, 1.0), texel.covers, part);
    texel.place *= part;
    texel.height *= part;
    light = light_when_cut(view.left, light, kind, view.area);
}

// Where a line of sight of this slope comes through the carpet so high over the ground [m].
vec3 met_at(float height, float slope) {
    float on = (mesh_share * tall - height) / max(slope, LOWEST);
    return gone_on(place, heading_to(place.xz) * clamp(on, -FARTHEST_SEEN, FARTHEST_SEEN));
}

// What lamps send to leaves that are seen, and how many leaves that meets: of the kind that is met most, for all of them.
vec4 lamps_seen(Sight sight) {
    int kind = 0;
    for (int other = 1; other < KINDS; other++)
        kind = OF(met, other) > OF(met, kind) ? other : kind;
    vec3 there = leaf_place(place, sight.slope, tall, leaf_area);
    vec2 bend = bending(kind, message_at(place.xz));
    there.y -= sight.share * tall;
    vec3 turned = turned_to(kind, leaning(bend), vec3(sight.heading, (there.y - eye.y) / max(distance(there.xz, eye.xz), TINY)).xzy);
    vec4 sent = lamps_at(there, Reflector(kind, bend, lie_at(there.xz).normal, 1.0));
    sent.rgb *= turned * turned * (1.0 - haze_opacity(place));
    return sent;
}

// The display colour of a kind, and its coverage; `taller` is how much higher what is seen is than the mean, of that.
vec4 kind_seen(int kind, Patch own, Reading read, Sight sight, float grain, View view, out float taller) {
#ifdef HEADS
    if (OF(bears, kind) > 0.0)
        read.level += coarser_heads(read.across * patch_side, sight.slope);
#endif
    Texel texel = texel_of(kind, own, read, sight.on_level, grain);
    Light light = view.light;
    float usual_height = texel.height / (1.0 + texel.taller) * OF(tops, kind);
    taller = texel.taller;
    place_leaves(kind, texel, view);
    if (has_casters())
        light = shadowed(light, casters_visibility(met_at(texel.height * OF(crown, kind), sight.slope)), 1.0);
    if (any_lamps())
        light = with_lamps(light, view.lamps);
    float bent = max(1.0 - (1.0 - texel.covers) * transmittance(view.bent.x), 0.0);
#ifdef HEADS
    float ripe = figure_at(riper, kind);
    texel.place += ripe * (ripe > 0.0 ? 1.0 - texel.place : texel.place);
    // What stands scattered among others has what is met of it where it stands, and nothing between.
    texel.covers = OF(bears, kind) > 0.0 ? texel.covers / max(texel.usual, LEAST_USUAL) : bent;
#else
    texel.covers = bent;
#endif
    if (anything_is_cut() && is_mown(view.left))
        cut_down(kind, texel, light, view, usual_height);
    vec3 pigment = pigment_at(kind, texel.place, texel.place * texel.eyed) * view.fresh * azimuth_tint(kind, doubled_angle(sight.heading) * texel.twice);
    return texel.covers * vec4(tone_mapped(shade(leaf_surface(pigment, texel.height), light)), 1.0);
}

// What all kinds show together, premultiplied, and how much taller it is than the mean.
vec4 kinds_seen(Patch own, Reading read, Sight sight, float grain, View view, out float taller) {
    vec4 sum = vec4(0.0);
    float higher = 0.0, one;
    int kind = next_kind(met, LEAST_MET, 0);
    if (kind < KINDS) do {
        float part = figure_at(met, kind);
        sum += part * kind_seen(kind, own, read, sight, grain, view, one);
        higher += part * one;
        kind = next_kind(met, LEAST_MET, kind + 1);
    } while (kind < KINDS);
    taller = higher / max(total(met), LEAST_TEXEL);
#ifdef HEADS
    sum /= max(sum.a, 1.0);
#endif
    return sum;
}
