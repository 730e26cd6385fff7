// Bending of pressed grass: the twin of systems/press/lie.py. `systems/press/card.py` fills the texture.
#include "lib/kinds.glsl"
#include "lib/least.glsl"
#include "systems/press/card.py"
#include "systems/press/lie.py"
#include "systems/press/marks.py"

uniform sampler2D pressed;  // the frame; responses of kinds; the squares' lists; fresh marks, then settled ones

const int SWINGS = PRESSED_ROW, SQUARES = 2 * PRESSED_ROW;  // first texels of responses and of squares

const float PAST_END = 1.001;  // samples before the end of a table at which it is last read

struct Lying {
    vec2 direction;  // direction in which grass lay before the last touch
    vec2 push;       // direction in which that pushes
    float index, trodden, depth, until;  // posture index and trodden amount before it; the index to which it presses; its end [s]
};

vec4 texel_of(int number) {
    return texelFetch(pressed, ivec2(number % PRESSED_ROW, number / PRESSED_ROW), 0);
}

vec2 normalised(vec2 vector) {
    return vector / max(length(vector), LEAST_SQUARE);
}

// Posture index after a constant wind of index 1 stopped: it swings past 0 and comes to rest.
float response_after_stop(float elapsed, int kind) {
    float at = clamp(elapsed / texel_of(2 + 2 * GROUP(kind))[IN_GROUP(kind)], 0.0, texel_of(0).z - PAST_END);
    float low = floor(at);
    int first = SWINGS + GROUP(kind) * int(texel_of(0).z) + int(low), own = IN_GROUP(kind);
    float before = texel_of(first)[own];
    return before + (texel_of(first + 1)[own] - before) * (at - low);
}

// Posture index at which trodden grass lies for now.
float lasting_index(float trodden) {
    return trodden * (2.0 - trodden);
}

// Posture index and trodden amount at an instant; `towards` is the direction in which grass lies.
vec2 state_at(Lying lying, float then, int kind, out vec2 towards) {
    float elapsed = max(then - lying.until, 0.0);
    float before = max(lying.index, lasting_index(lying.trodden));
    float trod = lying.trodden + TREAD_FRACTION * max(FLAT * (lying.depth * lying.depth) * (lying.depth * lying.depth) - lying.trodden, 0.0);
    float left = max(trod - elapsed / texel_of(1 + 2 * GROUP(kind))[IN_GROUP(kind)], 0.0);
    towards = normalised(lying.depth * lying.push + before * lying.direction);
    return vec2((max(lying.depth, before) - lasting_index(trod)) * response_after_stop(elapsed, kind) + lasting_index(left), left);
}

void apply_mark(inout Lying lying, int mark, vec2 place, int kind) {
    vec4 ends = texel_of(mark), times = texel_of(mark + 1), how = texel_of(mark + 2);
    vec2 from_first = place - ends.xy, way = ends.zw - ends.xy;
    float reach = times.w, size = length(way), small = max(size, LEAST_LENGTH);
    vec2 along = way / small;
    float at = dot(from_first, along), aside = from_first.x * along.y - from_first.y * along.x;
    vec2 off = from_first - clamp(at, 0.0, size) * along;
    float far = length(off);
    if (far >= reach)
        return;
    // Times at which the disc's edge arrives and leaves; what it covers at the end of the way it holds until it moves on.
    bool still = size < LEAST_LENGTH;
    float half_way = sqrt(max(reach * reach - aside * aside, 0.0)), took = times.y - times.x;
    float enter = (at - half_way) / small, leave = (at + half_way) / small;
    float begun = times.x + (still ? 0.0 : clamp(enter, 0.0, 1.0) * took);
    float ended = still || leave >= 1.0 ? times.z : times.x + leave * took;
    if (begun > lying.until + SAME_TOUCH) {
        vec2 towards, found = state_at(lying, begun, kind, towards);
        lying = Lying(towards, lying.push, max(found.x, 0.0), found.y, 0.0, LONG_AGO);
    }
    float fraction = far / reach, deep = how.x * (1.0 - fraction * fraction * fraction * fraction);
    if (deep > lying.depth) {
        lying.depth = deep;
        lying.push = normalised(off / reach + PUSH_ALONG * (1.0 - fraction) * how.yz);
    }
    lying.until = max(lying.until, ended);
}

vec4 lists_of(vec2 place) {
    ivec2 square = ivec2(floor(place / SQUARE)) & (SIDE - 1);
    return texel_of(SQUARES + square.y * SIDE + square.x);
}

// Whether the square of a ground position [m] has marks.
bool trodden_at(vec2 place) {
    return texel_of(0).y > 0.0 && dot(lists_of(place).yw, vec2(1.0)) > 0.0;
}

// Bending of pressed grass of a kind at a ground position [m]: a vector as long as the posture index.
vec2 pressing(vec2 place, int kind) {
    if (!trodden_at(place))
        return vec2(0.0);
    vec4 lists = lists_of(place);
    Lying lying = Lying(vec2(0.0), vec2(0.0), 0.0, 0.0, 0.0, LONG_AGO);
    int settled = int(lists.y), all = settled + int(lists.w);
    for (int k = 0; k < all; k++) {
        int at = k < settled ? int(lists.x) + k : int(lists.z) + k - settled;
        apply_mark(lying, int(texel_of(at >> 2)[at & 3]), place, kind);
    }
    vec2 towards, found = state_at(lying, texel_of(0).x, kind, towards);
    return found.x * towards;
}

// Sum of a message of the wind and the bending of pressed grass, whose index weakens the wind.
vec2 combined_message(vec2 message, vec2 pressing) {
    vec2 both = message * (1.0 - min(length(pressing), 1.0)) + pressing;
    return both / max(length(both), 1.0);
}
