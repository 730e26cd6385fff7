// Small oscillations of random direction and strength: the twin of systems/wind/flutter.py.

const float RIPPLE = 0.45, APART = 1.5 * 3.14159265358979;
const int FLUTTER = 5;  // numbers that `frame` has of it

// The oscillations at a ground position, for a swing of 1; `frame` has three phases, how far the noise is carried, and it.
vec2 flutter(vec2 place, Wind frame) {
    vec4 ripple = smooth_noise(frame, 0, place / RIPPLE + vec2(value(frame, 3), value(frame, 4)));
    vec3 beat = sin(APART * ripple.xyz + vec3(value(frame, 0), value(frame, 1), value(frame, 2)));
    return (0.6 + 0.4 * ripple.w) * vec2(beat.x + 0.5 * beat.z, beat.y);
}
