// Soft edges of masks: the twin of systems/wind/shape.py.

// The smoothstep of a value, which is clamped to [0, 1].
float eased(float value) {
    return smoothstep(0.0, 1.0, value);
}

// 1 between two bounds, falling to 0 at each over `width` [m].
float rim(float value, float least, float most, float width) {
    return eased(min(value - least, most - value) / width);
}
