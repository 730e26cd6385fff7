// Small oscillations of random direction and strength: the twin of systems/wind/flutter.py.

const float RIPPLE = 0.45, APART = 1.5 * 3.14159265358979;
const float LEAST_BEAT = 0.6;
const int FLUTTER = 5;  // count of numbers for it at the beginning of the frame's row

// The oscillations at a ground position, for a swing of 1.
vec2 flutter(vec2 place, Wind frame) {
    vec3 phases = vec3(value(frame, 0), value(frame, 1), value(frame, 2));
    vec2 shift = vec2(value(frame, 3), value(frame, 4));
    vec4 ripple = smooth_noise(frame, 0, place / RIPPLE + shift);
    vec3 beat = sin(APART * ripple.xyz + phases);
    return mix(LEAST_BEAT, 1.0, ripple.w) * vec2(beat.x + 0.5 * beat.z, beat.y);
}
