// The table of organs (systems/grow/organs.py), for scenes with plants other than grass; without them, all are blades.
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

// Tones of an organ at its root and at its tip.
vec2 tones_of(int organ) {
    return tones[organ];
}

#ifdef EYED
const vec2 dyed[ORGANS] = DYED;

// Fraction of the eye's colour of an organ at place `t` along it.
float eyed_at(int organ, float t) {
    vec2 ends = dyed[organ];
    return clamp((ends.y - t) / (ends.y - ends.x), 0.0, 1.0);
}

// Whether an organ has the eye's colour on its inner side only.
bool is_blotched(int organ) {
    return dyed[organ].x > 0.0 && dyed[organ].y < 1.0;
}
#endif

// Bending of an organ by the wind, relative to a blade's.
float give_of(int organ) {
    return gives[organ];
}

// Relative width of an organ at place `t` along it.
float width_of(int organ, float t) {
    float knot = t * float(KNOTS - 1);
    int low = min(int(knot), KNOTS - 2), row = organ * KNOTS + low;
    return mix(widths[row], widths[row + 1], knot - float(low));
}
#else
bool is_blade(int organ) {
    return true;
}

bool is_at_tip(int organ) {
    return false;
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
