#include "lib/light.glsl"

in vec3 place;
#if !defined(MOWN) || defined(UNDER)
in vec3 soil_seen;
#endif
#if KINDS > 4
vec4 veil;
vec3 lush;
ByKind leaf_area;
#else
in vec3 lush;
in vec4 veil;
#ifdef MOWN
in ByKind leaf_area;
#endif
#endif
#ifdef MOWN
in vec3 sunlit;
in vec3 skylit;
in vec2 to_light;
#endif

out vec4 pixel;

// From a low angle a pixel is a long stripe of ground: a sharper image is nearer to how grass looks there.
float sharper(vec2 dx, vec2 dy) {
    float one = dot(dx, dx), other = dot(dy, dy), longer = max(one, other);
    return sqrt(max(min(one, other) / longer, 1.0 / (STRETCH * STRETCH)));
}

#ifndef UNDER
const float LITTER_SHARPER = 0.4;  // how much finer texels are than a part, in levels: filtering takes grain away
const float LITTER_PARTS = 4.0;  // a long stripe is taken in so many parts at most, one behind the other

// What lies on the ground, litter and low leaves, in the mean over the pixel: over parts of it that lie one behind another
// along the line of sight. Where little of the ground is `bare`, seen between the grass, fewer do. Each part is read at the
// one level that fits best, which costs half as much in software as two; where one part is enough, two levels share it.
vec2 lying_seen(float bare) {
    vec2 dx = dFdx(place.xz), dy = dFdy(place.xz), along = dot(dx, dx) > dot(dy, dy) ? dx : dy, sum = vec2(0.0);
    float parts = min(1.0 / sharper(dx, dy), mix(1.0, LITTER_PARTS, min(5.0 * bare, 1.0))), count = max(ceil(parts - 0.1), 2.0);
    float level = log2(length(along) * float(textureSize(repeating, 0).x) / (LITTER_SIDE * parts)) - LITTER_SHARPER;
    float apart = max(2.0 - parts, 0.0) / count;  // levels from a part to the next
    vec2 step = along * (1.0 - 1.0 / parts) / (count - 1.0), first = place.xz - 0.5 * (count - 1.0) * step;
    float part = 0.0;
    do  // a rasteriser in software goes through the body once more where a loop asks first
        sum += textureLod(repeating, (first + part * step) / LITTER_SIDE, level + (part - 0.5 * count + 0.5) * apart).gb;
    while (++part < count);
    return sum / count;
}
#endif

#ifdef MOWN
const float STUBBLE = 1.5;  // how unevenly stubble stands, for how unevenly the grass did
float left;  // up to which height grass is left to stand, in the mean over the pixel [m]

float left_seen() {
    vec2 dx = dFdx(place.xz), dy = dFdy(place.xz);
    float fine = sharper(dx, dy);
    float here = textureGrad(mown, (place.xz - terrain_origin) / terrain_size, dx * fine / terrain_size, dy * fine / terrain_size).r;
    return can_be_mown(place.xz) ? here : tallest_grass;
}
#endif

#if defined(CARPET) && !defined(UNDER)
#include "lib/layered.glsl"
#include "lib/random.glsl"
#include "systems/show/carpet/border.glsl"
#include "systems/show/carpet/lit.glsl"
#ifdef TRODDEN
#include "systems/press/press.glsl"
#endif
uniform sampler2DArray images;  // place along the blade, height, twice the azimuth, coverage; premultiplied
uniform float slopes[SLOPES];   // their viewing slopes
uniform ByKind first;           // by kind: first layer of the images
uniform ByKind tops;            // by kind: how high the images reach, of the canopy's height
uniform ivec2 stock;            // patch models; seed

in float carpet;
in vec2 rise;
in float crest;
in float tall;
in float dense;
in ByKind met;
#ifdef HEADS
in ByKind riper;
uniform ByKind bears;  // by kind: whether it has any heads
#endif
in vec3 direct;
in vec3 open_to;
in vec4 reach;
in float lies;
#if KINDS > 4
vec3 dry;
float stands;
ByKind tipped;
const float strips_before = 1.0;  // pixels find out themselves
#else
in float strips_before;
in ByKind tipped;
in vec3 dry;
in float stands;
#endif

const int LEVEL = 2;  // so many of the lowest images show grass that hides most of itself

// How deep in the grass what lines of sight of some slopes meet is, of its height. For how it is bent they meet so many leaves
// more.
vec3 mean_depth(vec3 slope, vec3 more) {
    return depth_met(max(max(dense, 0.02) / slope + more, 0.0));
}

vec3 mean_depth(vec3 slope) {
    return mean_depth(slope, vec3(0.0));
}

// Which of the viewing elevations' images a ray sees: the first of two by number, and how far it is on the way to the next.
// At a low angle the way is told by how deep in the grass what it meets is in the mean, so that the mean of two images is as
// deep; from above, where it meets leaves as the reciprocal of its slope, by the slope's logarithm.
vec2 elevation_seen(float slope) {
    slope = max(slope, slopes[0]);
    int low = 0;
    for (int next = 1; next < SLOPES - 1; next++)
        low += int(slope > slopes[next]);
    vec3 of = vec3(slope, slopes[low], slopes[low + 1]), at = low < LEVEL ? mean_depth(of) : log(of);
    return vec2(float(low), clamp((at.x - at.y) / (at.z - at.y), 0.0, 1.0));
}

const float SHALLOWEST = 0.005;  // a line of sight counts as at least so steep, for how high up it meets blades

// How much more grass hides, seen at a slope between those of two images, than the mean of both: by the leaves that the
// steeper one shows it to have, of which a line of sight meets the more the lower it is. What is seen straight from above is
// taken for the steepest image.
float filled(float steeper, vec2 seen, float slope, float mean) {
    float meets = slopes[int(seen.x) + 1] / clamp(slope, SHALLOWEST, slopes[SLOPES - 1]);
    return (1.0 - pow(max(1.0 - steeper, 1e-3), meets)) / max(mean, 0.01);
}

const float LEAST_MET = 0.004;  // of a kind, as a part of all that is: of less, nothing is seen
const float LEAST = 0.01; // height of the carpet where nothing grows [m]
const float ARCHED = 0.33;  // how much less of their tips blades show from the side for how low they are bent
const float MET = 0.85;  // how deep leaves are that are met over a crest, of how deep the line of sight comes
const float UNEVEN = 0.75;  // how deep they are at least, of how deep they are on level ground: tips differ in height
const float SPIKES = 18.0;  // how much more leaves are met along an outline where taller plants stand
const float TALLER = 0.05;  // how much taller plants count at most, of the mean

const float STANDING = 0.9;  // how much it covers at least of what is behind an outline, where strips have just begun to give way

// How much of what is behind an outline the grass hides. A line of sight that passes `deep` below the top of the grass,
// whose leaf area falls off linearly with height, meets leaves of (deep / tall)^2 times the whole.
float outline_cover(float slope, float stands_out) {
    slope = max(slope, 1e-4);
    float before_crest = deepest(slope, crest, tall * stands);
    float leaves = dense / slope * stands_out;
    float hidden = 1.0 - exp(-CREST * leaves * before_crest * before_crest);
    return mix(1.0, hidden, smoothstep(0.0, 2.0 * LEAST, tall));  // bare ground is its own outline
}

// How steeply the carpet rises along the line of sight where taller grass begins: there it is seen, though the ground falls
// away behind a crest.
float rises_ahead() {
    vec2 dx = dFdx(place.xz), dy = dFdy(place.xz), to = normalize(place.xz - eye.xz + 1e-4);
    vec2 way = dot(dx, dx) > dot(dy, dy) ? vec2(dot(dx, to), dFdx(tall)) : vec2(dot(dy, to), dFdy(tall));
    return carpet * max(way.y * sign(way.x) / max(abs(way.x), 1e-4), 0.0);
}

#ifdef TRODDEN
// The light where somebody walks or has walked, and how far leaves are moved by that: a way is narrower than the mesh that
// light is made out on.
Sum trodden_light(float slope) {
    vec3 there = seen_at(place, slope, tall, dense);
    vec2 message = message_at(place.xz), messages[KINDS], blown[KINDS];
    float most = 0.0;
    for (int kind = 0; kind < KINDS; kind++) {
        vec2 pressed = pressing(place.xz, kind);
        most = max(most, length(pressed));
        blown[kind] = message;
        messages[kind] = laid_over(message, pressed);
    }
    Sum sum = Sum(direct, open_to, reach, lies, vec2(0.0));
    if (most < 1e-3)
        return sum;
    Lie here = lie_at(there.xz);
    Sum with = summed(met, slope, there, here, messages), without = summed(met, slope, there, here, blown);
    return Sum(max(sum.direct + with.direct - without.direct, 0.0),
               max(sum.open_to + with.open_to - without.open_to, 0.0), sum.shade + with.shade - without.shade,
               lies + with.lies - without.lies, with.sways - without.sways);
}
#endif

// How much of the carpet's grass is seen among strips, and how high in the canopy, both relative to a carpet without strips.
// Strips in front have stopped a part of the line of sight already, high up. The carpet lies at RAISED of its share of their
// height and hides what they have below it: it shows what is left of what both together would stop.
vec2 among_strips(float on_strips, float slope) {
    float leaves = dense / max(slope, slopes[0]), out_of_it = max(1.0 - RAISED * carpet / stands, 0.0);
    vec2 depth = mean_depth(vec3(1.0, 1.0 / max(on_strips, 1e-3), 1.0) * max(slope, slopes[0])).xy;
    float all = 1.0 - exp(-leaves), strips = 1.0 - exp(-leaves * on_strips), left = max(all - strips, 1e-4);
    float own = (all * depth.x - strips * out_of_it * depth.y) / left;
    return vec2((1.0 - exp(-leaves * (1.0 - on_strips))) / max(all, 1e-4), clamp((1.0 - own) / (1.0 - depth.x), 0.0, 1.0));
}

#include "systems/show/carpet/reading.glsl"

const vec2 MIDDLES = vec2(0.25, 0.9);// how much nearer to the tips, and to the canopy's top, the middles of arches are
const float ENDS = 0.1;              // how much farther from the top their ends are

// What leaves show from above as arches, whose middles lie at the top, of what they show upright: place along the blade, height.
vec2 arched(vec2 met, float lying) {
    return met * (1.0 + lying * (MIDDLES * (1.0 - met) - vec2(0.0, ENDS) * met));
}

// What the carpet shows: of grass and of the ground between, as much as there is of each, as of blades in front of it.
vec4 carpet_seen(float slope, float on_level, vec3 below, float share) {
    ivec2 cell = ivec2(floor(place.xz / patch_side));
    uint drawn = hash3(stock.y, cell.x, cell.y);
    int model = int(drawn % uint(stock.x)), side = int(drawn >> 16u) & 3;
    vec3 ray = place - eye;
    vec2 heading = ray.xz / max(length(ray.xz), 1e-4), turn = turned(heading, side);
    float above = smoothstep(0.0, 2.0, slope), lying = above * (1.0 - stands) / LODGED;
    Light lit = Light(direct, open_to, vec3(0.0), reach.x, reach.y, reach.zw);
    float more = lies;
    vec3 blown = blown_on(cell);
#ifdef TRODDEN
    if (trodden_at(place.xz)) {
        Sum light = trodden_light(slope);
        lit = Light(light.direct, light.open_to, vec3(0.0), light.shade.x, light.shade.y, light.shade.zw);
        more = light.lies;
        blown.xy += light.sways;
    }
#endif
    float between = exp(-more);  // what is seen between blades, of that between blades at rest
    vec2 depths = mean_depth(max(vec3(slopes[0], SHALLOWEST, 1.0), on_level), vec3(0.0, more, 0.0)).xy;
    float higher_up = (1.0 - depths.y) / (1.0 - depths.x);  // where blades are met, of where they are met at rest
    // A blade's doubled azimuth against the line of sight; what it is against the world's axes is as far turned.
    float sight = heading.x * heading.x - heading.y * heading.y, aside = 2.0 * heading.x * heading.y;
    vec2 seen = elevation_seen(on_level);
    Reading read = reading(cell, heading, turn, blown, seen, slope, on_level);
    float grain = grain_of(read, seen, slope, blown.z);
    vec2 among = vec2(1.0);
    if (min(share, 1.0 - strips_before) < 1.0)
        among = among_strips(come_through(place.xz, max(slope, 1e-4), carpet, tall, stands).y, on_level);
#ifdef MOWN
    bool cut = is_mown(left);
    float stubble = 1.0 - exp(-weighed(leaf_area, leaves_left(left)) / max(slope, 0.02));  // by the leaves that are left
#endif
    // Over a crest nothing is met that lies deeper than the line of sight comes.
    float deep = deepest(slope, crest, tall * stands);
    float deepest_of_all = max(1.0 - RAISED * (share * lifted(deep, crest, stands) / stands - deep), 0.1);
    float shallow = 1.0;
    if (deepest_of_all < 1.0 / MET)
        shallow = clamp(MET * deepest_of_all / depths.x, UNEVEN, 1.0);
    vec4 sum = vec4(0.0);
    float higher = 0.0;
    int coarsest = int(log2(float(textureSize(images, 0).x)) + 0.01), kind = next_kind(met, LEAST_MET, 0);
    if (kind < KINDS) do {
        float layer = OF(first, kind) + float((model * SLOPES + int(seen.x)) * 4 + side);
        vec3 low = vec3(read.low, layer), high = vec3(read.high, layer + 4.0);
        vec4 mean_low = layer_mean(images, int(low.z), coarsest);
        vec4 mean_high = layer_mean(images, int(high.z), coarsest);
        vec4 mean = mix(mean_low, mean_high, seen.y);
        vec4 image = mix(layer_at(images, low, read.level), layer_at(images, high, read.level), seen.y);
        image = mean + (image - mean) * grain;
        float fill = filled(mean_high.a, seen, on_level, mean.a);
        image *= fill;
        image.a = clamp(image.a, 0.0, 1.0);
        image.rgb = clamp(image.rgb, 0.0, image.a);
        vec3 mean_of = image.rgb / max(image.a, 1e-3);
        higher += OF(met, kind) * (mean_of.g * mean.a / max(mean.g, 1e-3) - 1.0);
#ifdef HEADS
        mean_of.r *= OF(bears, kind) > 0.0 ? 0.5 + 0.5 * among.y : among.y;  // leaves are darker deep down, heads are not
        mean_of.g *= among.y;
#else
        mean_of.rg *= among.y;
#endif
        mean_of.rg = 1.0 - (1.0 - mean_of.rg) * shallow;
#ifndef HEADS  // among plants in flower, grass is as bright as its images show it
        mean_of.rg *= higher_up * vec2(OF(tipped, kind), 1.0);
#endif
        mean_of.r *= 1.0 - ARCHED * (1.0 - above) * max(1.0 - stands, 0.0);
        mean_of.rg = arched(mean_of.rg, lying);
        mean_of.g *= OF(tops, kind);
        Light met_by = lit;
        float covers = max(1.0 - (1.0 - image.a) * between, 0.0);
#ifdef HEADS
        float ripe = OF(riper, kind);
        mean_of.r += ripe * (ripe > 0.0 ? 1.0 - mean_of.r : mean_of.r);
        // What stands scattered among others has what is met of it where it stands, and nothing between.
        covers = OF(bears, kind) > 0.0 ? image.a / max(mean.a * fill, 0.02) : covers;
#endif
#ifdef MOWN
        // What is left is taken for the same grass pressed together.
        if (cut) {
            float part = min(left / max(OF(crown, kind), 0.01), 1.0);
            float uneven = 1.0 + STUBBLE * (mean_of.g / max(OF(tops, kind) * mean.g / max(mean.a, 1e-3), 1e-3) - 1.0);
            covers = mix(min(stubble * uneven, 1.0), covers, part);
            mean_of.rg *= part;
            met_by = mown_to(left, lit, kind, leaf_area);
        }
#endif
        vec3 tint = (kinds[kind].grain_c * sight + kinds[kind].grain_s * aside) * (2.0 * mean_of.b - 1.0);
        vec3 pigment = mix(kinds[kind].root, kinds[kind].tip, mean_of.r) * dry * (1.0 + tint);
        sum += OF(met, kind) * covers * vec4(shown_of(mix(shade(leaf_at(pigment, mean_of.g), met_by), veil.rgb, veil.w)), 1.0);
        kind = next_kind(met, LEAST_MET, kind + 1);
    } while (kind < KINDS);
#ifdef HEADS
    sum /= max(sum.a, 1.0);
#endif
    float spikes = SPIKES * clamp(5.0 * share - 4.0, 0.0, 1.0);  // where the carpet sinks, they would swim
    // Who sees past grass over a crest sees no ground there, but the grass behind.
    float ends = smoothstep(0.5 * share, 1.5 * share, deep);
    sum *= among.x * mix(1.0 / max(sum.a, 0.05), 1.0, ends);
    return vec4(sum.rgb + below * (1.0 - min(sum.a, 1.0)), exp(spikes * clamp(higher / max(total(met), 1e-3), -TALLER, TALLER)));
}

#endif

#if KINDS > 4
// What is worked out at the corners of the mesh where kinds are few.
void work_out() {
    veil = vec4(haze_light(place), haze_at(place));
    lush = understorey_of(lie_at(place.xz), grows_at(place.xz));
#ifdef MOWN
    leaf_area = areas(grows_at(place.xz));
#endif
#if defined(CARPET) && !defined(UNDER)
    float slope = viewing_slope(rise, place);
    dry = stretch_seen(seen_at(place, slope, tall, dense), slope, tall);
    stands = lodged(message_at(place.xz));
    tipped = tips_met(grows_at(place.xz), level_slope(max(viewing_slope(rise, place), 0.0), crest, carpet, tall, stands));
#endif
}
#endif

void main() {
#if KINDS > 4
    work_out();
#endif
#if !defined(MOWN) || defined(UNDER)
    vec3 color = soil_seen;
#else
    left = left_seen();
    vec2 seen = exp(-to_light * weighed(leaf_area, leaves_left(left)));
    vec3 color = sunlit * seen.x + skylit * seen.y;  // the mesh is too coarse for the edges of what is mown
#endif
#ifndef UNDER
#ifdef CARPET
    float slope = viewing_slope(rise, place), bare = exp(-dense / max(slope, 0.02));
#else
    const float bare = 1.0;
#endif
    vec3 pigment = lying_pigment(lying_seen(bare), lush);
    color *= pigment * pigment;
#endif
    color = shown_of(mix(color, veil.rgb, veil.w));
#if defined(CARPET) && !defined(UNDER)
    float share = carpet > 0.0 ? share_at(ivec2(floor(place.xz / patch_side))) : 0.0;
    float top = slope + rises_ahead(), covered = mix(1.0, outline_cover(top, exp(SPIKES * TALLER)), min(3.0 * share, 1.0));
    // It writes its depth: where strips still stand on the patch, the thin edge of an outline would hide them.
    if (covered < max(0.004, STANDING * (1.0 - share)))
        discard;
    if (share > 0.0) {
        vec4 seen = carpet_seen(slope, level_slope(slope, crest, share, tall, stands), color, share);
        color = seen.rgb;
        if (covered < 0.999)
            covered = mix(1.0, outline_cover(top, seen.a), min(3.0 * share, 1.0));
    }
    pixel = vec4(color, 1.0) * covered;
#else
    pixel = vec4(color, 1.0);
#endif
}
