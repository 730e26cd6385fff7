// The canopy where grass is trodden, by pixel, as a trail is narrower than the mesh whose vertices light is computed at.
#include "systems/press/press.glsl"
#include "systems/show/carpet/lit.glsl"

const float HARDLY = 1e-3;  // least length of pressing that counts

// The canopy of the vertices, changed by pressing.
Canopy trodden(Canopy canopy, ByKind met, vec3 place, float slope, float on_level, vec3 there) {
    vec2 message = near_message_at(place.xz), messages[KINDS], blown[KINDS];
    float most = 0.0;
    for (int kind = 0; kind < KINDS; kind++) {
        vec2 pressed = pressing(place.xz, kind);
        most = max(most, length(pressed));
        blown[kind] = message;
        messages[kind] = combined_message(message, pressed);
    }
    if (most < HARDLY)
        return canopy;
    Lie lies = lie_at(there.xz);
    Canopy with = canopy_lit(met, slope, on_level, there, lies, messages);
    Canopy without = canopy_lit(met, slope, on_level, there, lies, blown);
    canopy.light = light_sum(light_sum(canopy.light, hazed(with.light, place), 1.0), hazed(without.light, place), -1.0);
    canopy.light.sun = max(canopy.light.sun, 0.0);
    canopy.light.sky = max(canopy.light.sky, 0.0);
    canopy.bent += with.bent - without.bent;
    canopy.sway = with.sway - without.sway;
    return canopy;
}
