// Stars, each as a square about its place in the picture.
#include "systems/light/sky.glsl"
#include "systems/light/stars.py"

in vec3 star;    // direction: towards the equator at right ascensions of 0 and 6 hours, and towards the pole
in vec3 bright;  // light; its luminance is 1 for magnitude 0

out vec2 aside;            // from the star's place [standard deviations of its spot]
flat out vec3 added;       // radiance that the star adds in the middle of its spot
flat out vec3 background;  // radiance of the sky there

uniform mat3 turn;           // from the stars' axes to the scene's
uniform float zenith_depth;  // optical depth of the air for a star overhead

const vec2 AIR = vec2(0.025, -11.0);            // of the mass of air by the elevation's sine (Rozenberg, Twilight, 1966)
const vec4 OUTSIDE = vec4(2.0, 2.0, 0.0, 1.0);  // a place in clip space that no picture shows

// Pixels of the picture in a solid angle about a direction [1/sr]: they are smaller away from its middle.
float pixels_per_solid_angle(float w) {
    float height = pixels_per_metre(), cosine = w / length(vec3(clip[0].w, clip[1].w, clip[2].w));
    return height * height / (cosine * cosine * cosine);
}

void main() {
    vec3 toward = turn * star;
    vec4 at = clip * vec4(toward, 0.0);
    gl_Position = OUTSIDE;
    if (toward.y <= 0.0 || at.w <= 0.0)
        return;
    aside = STAR_REACH * (2.0 * vec2(float(gl_VertexID & 1), float(gl_VertexID >> 1)) - 1.0);
    float through = transmittance(zenith_depth / (toward.y + AIR.x * exp(AIR.y * toward.y)));
    background = sky_toward(toward);
    vec2 place = at.xy / at.w;
    if (cloud_edge <= 1.0) {
        vec4 cloud = textureLod(clouds, 0.5 * place + 0.5, 0.0);
        background = clouds_before(background, cloud);
        through *= max(1.0 - cloud.w / out_of_haze(toward.y), 0.0);  // clouds fade into the haze, and hide as much there
    }
    added = starlight * through * pixels_per_solid_angle(at.w) / (2.0 * PI * STAR_SPOT * STAR_SPOT) * bright;
    gl_Position = vec4(place + aside * STAR_SPOT / half_screen, depth_ends.y, 1.0);
}
