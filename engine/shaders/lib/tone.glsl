// Tone mapping: from linear radiance to display colours.
#include "lib/frame.glsl"
#include "systems/light/color.py"

// The display colour of radiance by its root, by a curve with a toe and a shoulder; or the radiance itself, where the game asks for that.
vec3 tone_mapped_root(vec3 root_of) {
    if (writes_raw > 0.5)
        return root_of * root_of;
    root_of = min(root_of, WHITE);
    return root_of * (CURVE.x + root_of * (CURVE.y + root_of * CURVE.z));
}

// The same by the radiance.
vec3 tone_mapped(vec3 light) {
    light = max(light, 0.0);
    return writes_raw > 0.5 ? light : tone_mapped_root(sqrt(light));
}
