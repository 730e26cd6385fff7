// Tone mapping: from linear radiance to display colours.
#include "lib/frame.glsl"
#include "systems/light/color.py"

// The display colour of radiance, by a curve with a toe and a shoulder; or the radiance itself, where the game asks for that.
vec3 tone_mapped(vec3 light) {
    light = max(light, 0.0);
    if (writes_raw > 0.5)
        return light;
    vec3 root_of = min(sqrt(light), WHITE);
    return root_of * (CURVE.x + root_of * (CURVE.y + root_of * CURVE.z));
}
