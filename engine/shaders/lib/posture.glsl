// Postures: the place of a point on a bent blade (paper, section 3.2).
#include "lib/frame.glsl"

uniform sampler2DArray postures;

struct Spine {
    vec3 place;    // from the root
    vec3 tangent;  // towards the tip
};

// The form of a kind that a row of postures belongs to.
int form_of(float variant) {
    return int((variant + 0.5) / posture_variants);
}

// The bending vector of a kind for a message: along the message, as long as the posture index.
vec2 bending(int kind, vec2 message) {
    int lengths = give.length() / 4;
    float size = length(message), at = min(size, 1.0) * float(lengths - 1);
    int low = min(int(at), lengths - 2), row = GROUP(kind) * lengths + low, own = IN_GROUP(kind);
    return message / max(size, LEAST_SQUARE) * mix(give[row][own], give[row + 1][own], at - float(low));
}

// The point `t` of a blade of length 1 for a bending vector.
Spine posture(float variant, vec2 bend, float t) {
    float index = length(bend);
    vec2 heading = bend / max(index, LEAST_LENGTH);
    float column = (t * posture_links + 0.5) / (posture_links + 1.0);
    float row = ((0.5 + 0.5 * min(index, 1.0)) * (posture_rows - 1.0) + 0.5) / posture_rows;
    vec4 at = textureLod(postures, vec3(column, row, variant), 0.0);
    return Spine(vec3(heading.x * at.x, at.y, heading.y * at.x), vec3(heading.x * at.z, at.w, heading.y * at.z));
}
