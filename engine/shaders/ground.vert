// One instance is one square tile of the ground; its grid slides into the next coarser one with distance, so that
// tiles of different fineness meet without cracks.
#include "lib/light.glsl"
#include "lib/terrain.glsl"

in vec2 corner;  // of the grid, 0 .. GRID
in vec4 tile;    // x, z [m]; spacing [m]; distance at which the next coarser spacing has taken over [m]

#ifdef CARPET
#include "lib/shares.glsl"
uniform vec4 raised;  // by kind: height of the carpet above the ground [m]


out float carpet;
out vec2 rise;   // of the ground, along x and z
out float fuzz;  // height of the grass that stands out against what is behind [m]

float lowest_share(vec2 place) {
    ivec2 low = ivec2(floor((place - 0.01) / soil.w)), high = ivec2(floor((place + 0.01) / soil.w));
    return min(min(share_at(low), share_at(high)), min(share_at(ivec2(low.x, high.y)), share_at(ivec2(high.x, low.y))));
}
#endif

out vec3 place;
out vec3 soil_color;
out float veiled;  // by haze

void main() {
    vec2 flat_at = tile.xy + corner * tile.z;
    float slide = clamp(distance(flat_at, eye.xz) / tile.w * 4.0 - 3.0, 0.0, 1.0);
    flat_at -= fract(corner * 0.5) * 2.0 * tile.z * slide;
    flat_at = clamp(flat_at, terrain.xy, terrain.xy + field.xy);
    place = vec3(flat_at, height_at(flat_at)).xzy;
#ifdef CARPET
    carpet = lowest_share(flat_at);
    vec4 grows = textureLod(density, on_map(flat_at), 0.0);
    place.y += carpet * dot(grows, raised) / max(dot(grows, vec4(1.0)), 1.0);
    fuzz = dot(grows, raised) * 0.5;
    vec2 step = vec2(max(terrain.z, tile.z), 0.0);
    rise = vec2(height_at(flat_at + step.xy) - height_at(flat_at - step.xy), height_at(flat_at + step.yx) - height_at(flat_at - step.yx)) / (2.0 * step.x);
#endif
    soil_color = soil_light(flat_at);
    veiled = haze_at(place);
    gl_Position = clip * vec4(place, 1.0);
}
