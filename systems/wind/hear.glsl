// The resulting message of all winds at a receiver: the twin of systems/wind/blow.py.
// `systems/wind/card.py` fills the textures.

uniform sampler2D winds;             // a row for the frame, then one for each wind, the strongest claim first
uniform sampler2DArray wind_sheets;  // tables that twins read
uniform sampler2D wind_curves;       // a row for each kind of grass: index after a wind starts, after it stops; step [s]
uniform sampler2D wind_messages;     // of winds without a twin, to each receiver: message, weight

const float LONGEST_SQUARED = 1e12;  // square of the longest valid message
const float BEFORE_END = 0.001;  // curves are read up to this far before their last sample [samples]
const int HEAD = 4;  // texels before a row's numbers

struct Wind {
    int row;
    int grass;  // kind of grass at the receiver
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

// Indices `elapsed` [s] after a constant wind started, and after it stopped.
vec2 curve_at(Wind wind, float elapsed) {
    int last = textureSize(wind_curves, 0).x - 1;
    float stride = texelFetch(wind_curves, ivec2(0, wind.grass), 0).b;
    float at = clamp(elapsed / stride, 0.0, float(last) - BEFORE_END);
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

// Weighted sums over the winds so far at a receiver. Winds of equal claim are averaged before they cover others.
struct Claims {
    vec3 result, sum;   // message and swing: of all claims so far; of the present claim, weighted
    float total, kept;  // of the present claim: sum of the shares; product of (1 - share)
    float unclaimed;    // part of the receiver that no wind has claimed yet
    bool weighs;        // whether winds are mixed by weight
};

// A wind, and a receiver in its frame.
struct Query {
    Wind wind;
    vec4 pose;    // place; cosine and sine of the yaw
    vec4 terms;   // share of a claim; swing; 1 if the claim ends with this wind; number of the twin
    vec2 place;   // receiver in the wind's frame
    bool inside;  // whether the extent holds the receiver
};

Query query_of(int row, vec2 place, int kind) {
    vec4 pose = texelFetch(winds, ivec2(0, row), 0), extent = texelFetch(winds, ivec2(1, row), 0);
    vec2 from = place - pose.xy;
    vec2 local = vec2(pose.z * from.x + pose.w * from.y, pose.z * from.y - pose.w * from.x);
    bool inside = all(greaterThan(local, extent.xz)) && all(lessThan(local, extent.yw));
    return Query(Wind(row, kind), pose, texelFetch(winds, ivec2(2, row), 0), local, inside);
}

// Add a wind's message with its share to the present claim; lay the claim over the unclaimed part where it ends.
void lay(inout Claims claims, vec4 terms, vec2 message, float share) {
    claims.total += share;
    claims.kept *= 1.0 - share;
    claims.sum += share * vec3(message, terms.y);
    if (terms.z > 0.0 && claims.total > 0.0) {
        float covered = claims.unclaimed * (1.0 - claims.kept);
        claims.result += covered * claims.sum / claims.total;
        claims.unclaimed -= covered;
        claims.sum = vec3(0.0);
        claims.total = 0.0;
        claims.kept = 1.0;
    }
}

// Lay the message of a wind that has a twin.
void lay_twin(inout Claims claims, Query query, float weight, vec2 message) {
    // The comparisons are false for NaN, which so counts as no message.
    bool sent = query.inside && weight > 0.0 && dot(message, message) < LONGEST_SQUARED;
    float share = sent ? (claims.weighs ? min(weight, 1.0) : 1.0) * query.terms.x : 0.0;
    float c = query.pose.z, s = query.pose.w;
    vec2 turned = vec2(c * message.x - s * message.y, s * message.x + c * message.y);
    lay(claims, query.terms, sent ? turned : vec2(0.0), share);
}

// Lay the message of a wind without a twin.
void lay_untwinned(inout Claims claims, int row, int receiver) {
    vec4 terms = texelFetch(winds, ivec2(2, row), 0);
    int width = textureSize(wind_messages, 0).x, first = int(texelFetch(winds, ivec2(3, row), 0).x);
    vec3 sent = texelFetch(wind_messages, ivec2(receiver % width, first + receiver / width), 0).xyz;
    lay(claims, terms, sent.xy, sent.z * terms.x);
}

// Number of a wind's twin, -1 for none.
int twin_of(int row) {
    return int(texelFetch(winds, ivec2(2, row), 0).w);
}

// The row after the last wind of a run.
int end_of(int run) {
    return int(value(Wind(0, 0), FLUTTER + run));
}

#include "systems/wind/twins.glsl"

// The message to a receiver of a kind at a ground position [m]; `still` ones are without the small oscillations.
// `receiver` is its number in `wind_messages`.
vec2 hear(vec2 place, int kind, bool still, int receiver) {
    bool weighs = texelFetch(winds, ivec2(0, 0), 0).x > 0.0;
    Claims claims = Claims(vec3(0.0), vec3(0.0), 0.0, 1.0, 1.0, weighs);
    blow(claims, place, kind, receiver);
    vec2 message = claims.result.xy;
    if (!still && claims.result.z > 0.0) {
        message += claims.result.z * flutter(place, Wind(0, kind));
    }
    return message / max(length(message), 1.0);
}
