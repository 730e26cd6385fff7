// What the door shows of radiance.
#include "lib/frame.glsl"
#include "systems/light/color.py"

// What the door shows of radiance, with a toe in the shadows and a shoulder up to white; or the radiance itself.
vec3 shown_of(vec3 light) {
    light = max(light, 0.0);
    if (writes_raw > 0.5)
        return light;
    vec3 root_of = min(sqrt(light), WHITE);
    return root_of * (CURVE.x + root_of * (CURVE.y + root_of * CURVE.z));
}
