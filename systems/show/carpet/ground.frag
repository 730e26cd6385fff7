// Ground without carpet. With EDGED, grass ends or has been cut on it, and light is computed by pixel.
#define PIXELS_ASK
#ifndef EDGED
#define SUNWARD_BY_VERTEX
#endif
#include "lib/light.glsl"
#include "systems/show/carpet/litter.glsl"

in vec3 place;
centroid in vec3 haze;
#ifndef EDGED
centroid in vec3 soil_seen;
centroid in vec3 sunlit;
centroid in vec3 skylit;
centroid in float soil_extinction;
centroid in float soil_through;
centroid in vec3 lush;
#endif

out vec4 pixel;

#include "systems/show/carpet/stubble.glsl"

void main() {
#ifdef EDGED
    Lie lies = lie_at(place.xz);
    ByKind densities = density_at(place.xz);
    Soil soil = soil_lit(place, lies, densities, 1.0 - haze_opacity(place));
    vec3 lush = understorey_pigment(lies, densities);
#else
    Soil soil = Soil(soil_seen, sunlit, skylit, soil_extinction, soil_through);
#endif
    float cut_height = cut_height_seen(place.xz);
    vec3 pigment = ground_pigment(place.xz, dFdx(place.xz), dFdy(place.xz), 1.0, lush, cut_height);
    vec3 ground = soil_radiance(soil, place, cut_height);
    pixel = vec4(tone_mapped(ground * pigment * pigment + haze), 1.0);
#ifdef EDGED
    if (is_hole(place.xz))
        discard;
#endif
}
