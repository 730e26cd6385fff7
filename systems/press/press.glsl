// What grass feels of those who walk through it: the twin of systems/press/lie.py. `systems/press/card.py` fills the texture.
#include "lib/kinds.glsl"
#include "lib/least.glsl"
#include "systems/press/card.py"
#include "systems/press/lie.py"
#include "systems/press/marks.py"

uniform sampler2D pressed;  // the frame; how kinds swing back; the squares' lists; fresh marks, then settled ones

const int SWINGS = PRESSED_ROW, SQUARES = 2 * PRESSED_ROW;  // texels before them

const float PAST_END = 1.001;  // samples before the end of a table that it is read at last

struct Lying {
    vec2 lay;    // where grass lay before
    vec2 aside;  // where it is pressed to
    float was, trod, deep, until;
};

vec4 texel_of(int number) {
    return texelFetch(pressed, ivec2(number % PRESSED_ROW, number / PRESSED_ROW), 0);
}

vec2 unit(vec2 vector) {
    return vector / max(length(vector), LEAST_SQUARE);
}

// The index after a constant wind stopped: 1 before, past 0 and back to 0.
float swung_back(float elapsed, int kind) {
    float at = clamp(elapsed / texel_of(2 + 2 * GROUP(kind))[IN_GROUP(kind)], 0.0, texel_of(0).z - PAST_END);
    float low = floor(at);
    int first = SWINGS + GROUP(kind) * int(texel_of(0).z) + int(low), own = IN_GROUP(kind);
    float before = texel_of(first)[own];
    return before + (texel_of(first + 1)[own] - before) * (at - low);
}

// The index at which trodden grass lies.
float stays(float trod) {
    return trod * (2.0 - trod);
}

// The index at an instant; how far it is trodden then. `towards` is where it lies.
vec2 left_at(Lying lying, float then, int kind, out vec2 towards) {
    float elapsed = max(then - lying.until, 0.0);
    float before = max(lying.was, stays(lying.trod));
    float trod = lying.trod + TREADS * max(FLAT * (lying.deep * lying.deep) * (lying.deep * lying.deep) - lying.trod, 0.0);
    float left = max(trod - elapsed / texel_of(1 + 2 * GROUP(kind))[IN_GROUP(kind)], 0.0);
    towards = unit(lying.deep * lying.aside + before * lying.lay);
    return vec2((max(lying.deep, before) - stays(trod)) * swung_back(elapsed, kind) + stays(left), left);
}

void touch(inout Lying lying, int mark, vec2 place, int kind) {
    vec4 ends = texel_of(mark), times = texel_of(mark + 1), how = texel_of(mark + 2);
    vec2 from_first = place - ends.xy, way = ends.zw - ends.xy;
    float reach = times.w, size = length(way), small = max(size, LEAST_LENGTH);
    vec2 along = way / small;
    float at = dot(from_first, along), aside = from_first.x * along.y - from_first.y * along.x;
    vec2 off = from_first - clamp(at, 0.0, size) * along;
    float far = length(off);
    if (far >= reach)
        return;
    // The disc's edge comes and goes: what it holds at the end it holds until it leaves.
    bool still = size < LEAST_LENGTH;
    float half_way = sqrt(max(reach * reach - aside * aside, 0.0)), took = times.y - times.x;
    float enter = (at - half_way) / small, leave = (at + half_way) / small;
    float begun = times.x + (still ? 0.0 : clamp(enter, 0.0, 1.0) * took);
    float ended = still || leave >= 1.0 ? times.z : times.x + leave * took;
    if (begun > lying.until + SAME) {
        vec2 towards, found = left_at(lying, begun, kind, towards);
        lying = Lying(towards, lying.aside, max(found.x, 0.0), found.y, 0.0, LONG_AGO);
    }
    float part = far / reach, deep = how.x * (1.0 - part * part * part * part);
    if (deep > lying.deep) {
        lying.deep = deep;
        lying.aside = unit(off / reach + AHEAD * (1.0 - part) * how.yz);
    }
    lying.until = max(lying.until, ended);
}

vec4 lists_at(vec2 place) {
    ivec2 square = ivec2(floor(place / SQUARE)) & (SIDE - 1);
    return texel_of(SQUARES + square.y * SIDE + square.x);
}

// Whether there is anything to look for at a ground position [m].
bool trodden_at(vec2 place) {
    return texel_of(0).y > 0.0 && dot(lists_at(place).yw, vec2(1.0)) > 0.0;
}

// How grass of a kind is pressed at a ground position [m], as a vector as long as the posture index.
vec2 pressing(vec2 place, int kind) {
    if (!trodden_at(place))
        return vec2(0.0);
    vec4 lists = lists_at(place);
    Lying lying = Lying(vec2(0.0), vec2(0.0), 0.0, 0.0, 0.0, LONG_AGO);
    int settled = int(lists.y), all = settled + int(lists.w);
    for (int k = 0; k < all; k++) {
        int at = k < settled ? int(lists.x) + k : int(lists.z) + k - settled;
        touch(lying, int(texel_of(at >> 2)[at & 3]), place, kind);
    }
    vec2 towards, found = left_at(lying, texel_of(0).x, kind, towards);
    return found.x * towards;
}

// The wind's message where grass is pressed as well: as much as it is, the wind is not.
vec2 laid_over(vec2 message, vec2 pressing) {
    vec2 both = message * (1.0 - min(length(pressing), 1.0)) + pressing;
    return both / max(length(both), 1.0);
}
