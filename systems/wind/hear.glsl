// What grass feels of all winds together: the twin of systems/wind/blow.py. `systems/wind/card.py` fills the textures.

uniform sampler2D winds;             // a row for the frame, then one for each wind, the strongest claim first
uniform sampler2DArray wind_sheets;  // tables that winds read
uniform sampler2D wind_curves;       // a row for each kind of grass: index after a wind starts, after it stops; step [s]
uniform sampler2D wind_told;         // what winds without a twin tell each receiver: message, weight

const float FARTHEST_SENT = 1e12;  // square of the longest message that counts
const float INSIDE = 0.001;  // of a step before the end of a curve, so that two of its places can be read
const int HEAD = 4;  // texels before a row's numbers

struct Wind {
    int row;
    int grass;  // the kind of grass that it is asked for
};

// One of the numbers of a wind's `twin_values`.
float value(Wind wind, int number) {
    return texelFetch(winds, ivec2(HEAD + (number >> 2), wind.row), 0)[number & 3];
}

// One texel, (column, row), of a sheet of a wind's `twin_values`.
vec4 sheet(Wind wind, int number, ivec2 at) {
    float layer = texelFetch(winds, ivec2(3, wind.row), 0)[number];
    return texelFetch(wind_sheets, ivec3(at, int(layer)), 0);
}

vec2 curve_at(Wind wind, float elapsed) {
    int last = textureSize(wind_curves, 0).x - 1;
    float stride = texelFetch(wind_curves, ivec2(0, wind.grass), 0).b;
    float at = clamp(elapsed / stride, 0.0, float(last) - INSIDE);
    vec2 low = texelFetch(wind_curves, ivec2(int(at), wind.grass), 0).rg;
    return mix(low, texelFetch(wind_curves, ivec2(int(at) + 1, wind.grass), 0).rg, fract(at));
}

// The index `elapsed` [s] after a constant wind started: 0 before, past 1 and back to 1.
float after_start(Wind wind, float elapsed) {
    return curve_at(wind, elapsed).x;
}

// The index `elapsed` [s] after it stopped: 1 before, past 0 and back to 0.
float after_stop(Wind wind, float elapsed) {
    return curve_at(wind, elapsed).y;
}

#include "systems/wind/shape.glsl"
#include "systems/wind/noise.glsl"
#include "systems/wind/flutter.glsl"

// How far the winds have come at a receiver: what is heard, and of winds of one claim what they say so far.
struct Claims {
    vec3 heard, sum;    // message; swing
    float total, kept;  // of one claim: sum of the shares; what they leave together
    float left;         // what no wind has claimed yet
    bool weighs;        // whether winds are mixed by weight
};

// One wind, asked by one receiver.
struct Asked {
    Wind wind;
    vec4 pose;  // place; cosine and sine of the yaw
    vec4 how;   // share in a claim; swing; whether a claim ends with it; number of the twin
    vec2 own;   // the receiver's place in its frame
    bool held;  // whether its extent holds it
};

Asked asked(int row, vec2 place, int kind) {
    vec4 pose = texelFetch(winds, ivec2(0, row), 0), extent = texelFetch(winds, ivec2(1, row), 0);
    vec2 from = place - pose.xy;
    vec2 own = vec2(pose.z * from.x + pose.w * from.y, pose.z * from.y - pose.w * from.x);
    bool held = all(greaterThan(own, extent.xz)) && all(lessThan(own, extent.yw));
    return Asked(Wind(row, kind), pose, texelFetch(winds, ivec2(2, row), 0), own, held);
}

// Lay the message of a wind, with the share that it claims, over what is left.
void lay(inout Claims claims, vec4 how, vec2 message, float share) {
    claims.total += share;
    claims.kept *= 1.0 - share;
    claims.sum += share * vec3(message, how.y);
    if (how.z > 0.0 && claims.total > 0.0) {
        float covered = claims.left * (1.0 - claims.kept);
        claims.heard += covered * claims.sum / claims.total;
        claims.left -= covered;
        claims.sum = vec3(0.0);
        claims.total = 0.0;
        claims.kept = 1.0;
    }
}

void lay_sent(inout Claims claims, Asked one, float weight, vec2 message) {
    // What is no number counts for nothing, as what is not above 0.
    bool sent = one.held && weight > 0.0 && dot(message, message) < FARTHEST_SENT;
    float share = sent ? (claims.weighs ? min(weight, 1.0) : 1.0) * one.how.x : 0.0;
    float c = one.pose.z, s = one.pose.w;
    vec2 turned = vec2(c * message.x - s * message.y, s * message.x + c * message.y);
    lay(claims, one.how, sent ? turned : vec2(0.0), share);
}

void lay_told(inout Claims claims, int row, int receiver) {
    vec4 how = texelFetch(winds, ivec2(2, row), 0);
    int width = textureSize(wind_told, 0).x, first = int(texelFetch(winds, ivec2(3, row), 0).x);
    vec3 told = texelFetch(wind_told, ivec2(receiver % width, first + receiver / width), 0).xyz;
    lay(claims, how, told.xy, told.z * how.x);
}

// The number of a wind's twin, -1 for one that has none.
int twin_of(int row) {
    return int(texelFetch(winds, ivec2(2, row), 0).w);
}

// Where a run of winds ends.
int end_of(int run) {
    return int(value(Wind(0, 0), FLUTTER + run));
}

#include "systems/wind/twins.glsl"

// The message to a receiver of a kind at a ground position [m]; `still` ones are without the small oscillations.
// `receiver` is its number, by which winds without a twin tell it something.
vec2 hear(vec2 place, int kind, bool still, int receiver) {
    bool weighs = texelFetch(winds, ivec2(0, 0), 0).x > 0.0;
    Claims claims = Claims(vec3(0.0), vec3(0.0), 0.0, 1.0, 1.0, weighs);
    blow(claims, place, kind, receiver);
    vec2 message = claims.heard.xy;
    if (!still && claims.heard.z > 0.0) {
        message += claims.heard.z * flutter(place, Wind(0, kind));
    }
    return message / max(length(message), 1.0);
}
