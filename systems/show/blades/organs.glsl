// What organs of plants are like, where a scene has plants other than grass; without, all are blades themselves.
#ifdef ORGANS
bool is_blade(int organ) {
    return organ == BLADE_ITSELF;
}

bool is_at_tip(int organ) {
    return (AT_TIPS >> organ & 1) != 0;
}

bool is_leaf(int organ) {
    return (LEAVES >> organ & 1) != 0;
}

const vec2 tones[ORGANS] = TONES;
const float gives[ORGANS] = GIVES;
const float widths[ORGANS * KNOTS] = WIDTHS;

// How much of the tip's pigment it has at its own ends.
vec2 tones_of(int organ) {
    return tones[organ];
}

#ifdef EYED
const vec2 dyed[ORGANS] = DYED;

// How far it has the colour of its head's eye at part `t` of its length.
float eyed_at(int organ, float t) {
    vec2 ends = dyed[organ];
    return clamp((ends.y - t) / (ends.y - ends.x), 0.0, 1.0);
}

// Whether it has that colour within alone: from outside, nothing of it is seen.
bool is_blotched(int organ) {
    return dyed[organ].x > 0.0 && dyed[organ].y < 1.0;
}
#endif

// How far it gives way to wind, of how far a blade does.
float give_of(int organ) {
    return gives[organ];
}

// How wide it is at part `t` of its length, of its own width.
float width_of(int organ, float t) {
    float at = t * float(KNOTS - 1);
    int low = min(int(at), KNOTS - 2), row = organ * KNOTS + low;
    return mix(widths[row], widths[row + 1], at - float(low));
}
#else
bool is_blade(int organ) {
    return true;
}

bool is_leaf(int organ) {
    return false;
}

vec2 tones_of(int organ) {
    return vec2(0.0, 1.0);
}


float give_of(int organ) {
    return 1.0;
}

float width_of(int organ, float t) {
    return 1.0;
}
#endif
