// The carpet of cheaper presets, without lamps: one image of each kind, one light for all kinds, and the brightness of litter on the
// ground between. The rest of what carpet.frag does by pixel is computed at the vertices.
#define PIXELS_ASK
#include "lib/light.glsl"
#include "lib/tone.glsl"
#include "systems/show/carpet/lying.glsl"
#include "systems/show/carpet/outline.glsl"
#include "systems/show/carpet/texel.glsl"
#define PASSED in
#include "systems/show/carpet/coarse.glsl"

out vec4 pixel;

uniform int part;  // pixels to draw: 0, all; 1, those with a coverage of at least half; 2, the others
const int ROWS = 40503;  // numbers of cells from one row to the next
const float BITS = 16.0;  // in each half of the random bits of a patch
const uint LOWER_HALF = 0xFFFFu;

// Random bits of a patch.
uint bits_of(ivec2 cell) {
    return scramble(uint(cell.x * ROWS + cell.y ^ stock.y));
}

// The carpet's share on a cell: its own near the viewer, where patches differ, and that of the mesh beyond.
float share_on(ivec2 cell) {
    vec2 apart = abs(vec2(cell) - carpet_window.xy);
    return max(apart.x, apart.y) > carpet_window.z ? mesh_share : textureLod(shares, (vec2(cell) + 0.5) * windows_per_patch, 0.0).r;
}

// Texture coordinates and image that a pixel reads of each kind.
struct Look {
    vec2 at;        // texture coordinates
    int image;      // index among the images of a kind
    ivec2 between;  // images of both slopes
    vec2 weights;   // of both slopes in the mean
    vec2 means;     // weights of their means beside the image with its gain of contrast
};

// Of the images of two slopes each patch shows one, chosen at random by their weights.
Look look_along(vec2 heading, uint random_bits) {
    vec2 here = unsheared(fract(place.xz * patches_per_metre) - blown * patches_per_metre - 0.5, heading, blown * leaning);
    float upper = float(random_bits >> UPPER_HALF);
    int low = min(int(elevation), SLOPES - 2), slope = min(int(elevation + upper * exp2(-BITS)), low + 1);
    int side = int(random_bits >> UPPER_HALF) & (HEADINGS - 1);
    int model = int((float(random_bits & LOWER_HALF) + 0.5) * (float(stock.x) * exp2(-BITS)));
    float along = dot(here, heading) * (stretch.x / slopes[slope] - stretch.y);
    ivec3 image = (model * SLOPES + ivec3(low, low + 1, slope)) * HEADINGS + side;
    vec2 place_in_image = rotated(here + heading * along, image_turn(heading, side)) + 0.5;
    float steeper = elevation - float(low), own = steeper - grain * float(slope - low);
    return Look(place_in_image, image.z, image.xy, vec2(1.0 - steeper, steeper), vec2(1.0 - grain - own, own));
}

// Sums over all kinds, weighted by coverage: pigment and height; and coverage.
struct Grass {
    vec3 pigment;
    float height;
    float covers;
};

void add_kind(inout Grass sum, int kind, Look look) {
    float part = OF(met, kind), from = OF(first, kind);
    vec4 lower = layer_mean(images, int(from) + look.between.x, stock.z), steeper = layer_mean(images, int(from) + look.between.y, stock.z);
    vec4 mean = lower * look.weights.x + steeper * look.weights.y;
    vec4 image = lower * look.means.x + steeper * look.means.y + layer_at(images, vec3(look.at, from + float(look.image)), level) * grain;
    float covers = clamp(1.0 - clamp(1.0 - image.a, 0.0, 1.0) * bent_through, 0.0, 1.0);
    vec3 shown = clamp(image.rgb / max(image.a, LEAST_TEXEL), 0.0, 1.0);
    vec2 at = places.xy + places.zw * shown.rg;
#ifdef HEADS
    float ripe = OF(riper, kind);
    at.x += ripe * (ripe > 0.0 ? 1.0 - at.x : at.x);
    covers = OF(bears, kind) > 0.0 ? clamp(image.a / max(mean.a, LEAST_MEAN), 0.0, 1.0) : covers;
#endif
    covers *= part;
    float eyed = 0.0;
#ifdef EYED
    if (has_eyes(kind, false))
        eyed = eye_share(shown);
#endif
    sum.pigment += covers * pigment_at(kind, at.x, at.x * eyed);
    sum.height += covers * at.y * OF(tops, kind);
    sum.covers += covers;
}

Grass grass_seen(vec2 heading, uint random_bits) {
    Look look = look_along(heading, random_bits);
    Grass sum = Grass(vec3(0.0), 0.0, 0.0);
    for (int kind = 0; kind < KINDS; kind++)
        if (OF(met, kind) > LEAST_MET)
            add_kind(sum, kind, look);
    float all = 1.0 / max(sum.covers, LEAST_TEXEL);
    return Grass(sum.pigment * all, sum.height * all, min(sum.covers, 1.0));
}

// Opacity of the grass along an outline, that of a crest or of a rim.
float hides_behind(float slope) {
    float wide = inversesqrt(crest);
    vec2 path = max(slope * abs(slope) * (wide * wide) + in_pixel, 0.0), leaves = crest_leaves * wide * path * sqrt(path);
    if (rim_path < NO_RIM)
        leaves = vec2(rim_leaves * rim_path * rim_path);
    return 1.0 - dot(transmittance(leaves), vec2(HALF));
}

// Brightness of the litter on a patch, of which little is seen between the grass: each patch shows another part of the texture.
float litter_on_patch(uint random_bits) {
    vec2 part = vec2(random_bits & LOWER_HALF, random_bits >> UPPER_HALF) * exp2(-BITS);  // from where on in the patch
    return textureLod(repeating, fract(place.xz * patches_per_metre) * (patch_side / LITTER_SIDE) + part, litter_level).g;
}

void main() {
    ivec2 cell = ivec2(floor(place.xz * patches_per_metre));
    uint random_bits = bits_of(cell);
    float share = mesh_share > 0.0 ? share_on(cell) : 0.0, covered = 1.0;
    vec2 shadow = has_casters() ? mix(in_shade, vec2(1.0), casters_visibility(place)) : vec2(1.0);
    vec3 color = soil_seen * (shadow.y * litter_on_patch(random_bits));
    if (share > 0.0) {
        vec2 ray = place.xz - eye.xz;
        Grass grass = grass_seen(ray * inversesqrt(max(dot(ray, ray), TINY * TINY)), random_bits);
        vec3 lit = max(lit_root + root_rise * grass.height, 0.0) * sqrt(shadow.x);
        vec3 leaves = tone_mapped_root(grass.pigment * lit + air_root);
        float square = max(facing, 0.0) * max(facing, 0.0), covers = grass.covers;
        if (square < outlined_to || rim_path < NO_RIM) {
            float ends = smoothstep(ENDS.x * share, ENDS.y * share, square / crest_deep);
            covers = mix(min(covers / LEAST_COVER, 1.0), covers, ends);
            covered = mix(1.0, hides_behind(facing), min(share / SHOWN_FROM, 1.0));
        }
        covers *= past_strips;
        color = color * (1.0 - covers) + leaves * covers;
    }
    if (covered < max(NOTHING, STANDING * (1.0 - share)))
        discard;
    pixel = vec4(color, 1.0) * covered;
    if (part != 0 && pixel.a < HALF == (part == 1))
        discard;
}
