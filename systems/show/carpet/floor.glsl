// The ground between plants, lit through the grass and in the open.
#include "lib/soil.glsl"

// Radiance of the soil under the grass that stands there, and without any grass by the sun and by the sky alone.
struct Soil {
    vec3 seen;  // under the grass, without haze
    vec3 sunlit;
    vec3 skylit;
    float extinction;  // of sunlight: optical depth for each 1 of leaf area seen from the side
    float through;     // transmittance of the grass for sunlight
};

// Light the soil; `clear` is the transmittance of the air before it.
Soil soil_lit(vec3 place, Lie lies, ByKind densities, float clear) {
    Surface surface = soil_surface(lies, densities);
    float leaves = total(leaf_areas(densities));
    Light light = light_on_soil(place, lies, leaves);
    vec3 seen = shade(surface, light);
    light.leaves = vec2(0.0);
    vec3 both = shade(surface, light);
    light.sun = vec3(0.0);
    vec3 sky = shade(surface, light);
    if (any_lamps()) {  // lamps count as sky
        light.sun = sunlight * (SOIL_SENDS * lies.sun_sine * sun_visibility(place, lies.visibility));
        light.sky = vec3(0.0);
        sky = both - shade(surface, light);
    }
    return Soil(seen * clear, (both - sky) * clear, sky * clear, light.extinction, transmittance(light.extinction * leaves));
}
