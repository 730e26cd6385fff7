#define PASSED in
#include "systems/show/blades/ribbon.glsl"
#ifdef TOOTHED
#include "systems/show/blades/toothed.glsl"
#endif
#ifdef DEEP
#include "systems/show/deep.glsl"
#else
#include "systems/show/blades/veins.glsl"
#endif
#ifdef SOFT
const float THINNEST = 0.01;  // least half width of a ribbon that counts [pixel]
const float FAINT = 0.004;  // coverage that is left out: in bytes, it would only be rounded up
#endif

out vec4 pixel;

// Drawn width of a ribbon relative to its own: soft edges reach beyond it.
float widening() {
#ifdef SOFT
    return 1.0 + EDGE / max(half_width, THINNEST);
#else
    return 1.0;
#endif
}

void main() {
#ifdef TOOTHED
    vec2 place = place_in_ligules(widening()), pixel_size = fwidth(place);
#endif
#if !defined(SOFT) && !defined(DEEP)
    float place_across = across.x / across.y, half_wide = 1.0 / fwidth(place_across);
#endif
#ifdef SOFT
    float wide = half_width, outside_slits = 1.0;
    vec3 radiance = color;
#ifndef DEEP
    radiance *= vein_brightness(veined, aside / max(half_width, THINNEST), half_width);
#endif
#ifdef TOOTHED
    if (outlined != 0.0) {
        Outline outline = outline_at(aside, place, pixel_size);
        wide *= outline.width;
        radiance *= outline.brightness;
        outside_slits = outline.coverage;
    }
#endif
    float covered = shown * outside_slits * clamp((wide + EDGE - abs(aside)) * (0.5 / EDGE), 0.0, min(1.0, wide / EDGE));
#ifdef ORGANS
    covered *= clamp(half_length + 0.5 - abs(onward), 0.0, min(1.0, 2.0 * half_length));
#endif
    covered = covered >= FAINT ? covered : 0.0;
#ifdef DEEP
    if (covered < depth_threshold(number, clamp(2.0 - 2.0 * half_width, 0.0, 1.0)))
        discard;
#endif
#ifdef PARTED
    if (covered == 0.0 || (covered < hides) == (part == 1))
        discard;
#endif
#ifdef DEEP
    pixel = vec4(0.0);
#elif defined(FOLDS)
    // Each face of a fold is evenly lit: the ramp between the corners becomes a step.
    pixel = vec4((radiance + keel * (clamp(2.0 * aside, -1.0, 1.0) - aside / (half_width + EDGE))) * covered, covered);
#else
    pixel = vec4(radiance * covered, covered);
#endif
#else
    vec3 radiance = color;
#ifndef DEEP
    radiance *= vein_brightness(veined, place_across, half_wide);
#endif
#ifdef TOOTHED
    if (outlined != 0.0) {
        Outline outline = outline_at(tooth_side.x, place, pixel_size);
        if (outline.coverage < 0.5 || abs(tooth_side.x) > outline.width && outlined > 0.0)
            discard;
        radiance *= outline.brightness;
    }
#endif
    pixel = vec4(radiance * shown, shown);
#endif
}
