in vec3 color;
flat in float shown;
#ifdef FOLDS
in vec3 keel;  // how much brighter the face to the right of a fold is than both
#endif
#ifdef SOFT
uniform int part;     // 0: all of it; 1: where it hides what is behind it; 2: the rest
flat in float hides;  // coverage from which on it does
noperspective in float aside;
noperspective in float half_width;
#endif

out vec4 pixel;

void main() {
#ifdef SOFT
    float covered = shown * clamp(half_width + 0.5 - abs(aside), 0.0, min(1.0, 2.0 * half_width));
    if (covered < 0.004 || (part == 1 && covered < hides) || (part == 2 && covered >= hides))
        discard;
#ifdef FOLDS
    // Each face of a fold is evenly lit: the ramp from side to side, as corners have it, becomes a step.
    pixel = vec4((color + keel * (clamp(2.0 * aside, -1.0, 1.0) - aside / (half_width + 0.5))) * covered, covered);
#else
    pixel = vec4(color * covered, covered);
#endif
#else
    pixel = vec4(color * shown, shown);
#endif
}
