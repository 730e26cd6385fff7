// One instance is one blade: a ribbon of SEGMENTS quads. With SOFT it is drawn half a pixel wider on either side, and the
// fragments say how much of each pixel it covers; so a blade thinner than a pixel is faint, and not a row of dots.
#include "lib/light.glsl"
#include "lib/posture.glsl"

in vec3 root_at;
in float height;
in vec2 rest;
in vec2 facing;
in float width;
in float variant;
in float kind;
in vec2 message;
in float fade;

out vec3 color;
flat out float shown;
#ifdef SOFT
noperspective out float aside;  // from the middle line [pixel]
noperspective out float half_width;  // of the ribbon [pixel]

// Move a point aside on the screen, so that the ribbon reaches half a pixel beyond its edge.
vec4 widened(vec3 place, vec3 tangent, vec2 across, float reach) {
    vec4 middle = clip * vec4(place, 1.0);
    vec4 edge = clip * vec4(across.x * reach, 0.0, across.y * reach, 0.0);
    if (middle.w < 0.15) {
        aside = half_width = 8.0;
        return middle + edge;
    }
    vec4 ahead = clip * vec4(tangent, 0.0);
    vec2 run = (ahead.xy * middle.w - middle.xy * ahead.w) * screen.xy;
    vec2 wide = (edge.xy * middle.w - middle.xy * edge.w) * screen.xy / (middle.w * middle.w);
    vec2 normal = vec2(-run.y, run.x) / max(length(run), 1e-9);
    float signed_width = dot(wide, normal);
    half_width = abs(signed_width);
    aside = (half_width + 0.5) * (gl_VertexID % 2 == 0 ? -1.0 : 1.0);
    middle.xy += normal * aside / screen.xy * middle.w;
    return middle;
}
#endif

void main() {
    float t = float(gl_VertexID / 2) / float(SEGMENTS);
    float side = float(gl_VertexID % 2) * 2.0 - 1.0;
    int k = int(kind);
    vec2 bend = message + rest * (1.0 - min(length(message), 1.0));
    Spine spine = posture(variant, bend, t);
    vec3 place = root_at + spine.place * height;
    vec2 across = vec2(-facing.y, facing.x) * side;
    float reach = 0.5 * width * pow(max(1.0 - t, 0.0), tip[k].w);
#ifdef SOFT
    gl_Position = widened(place, spine.tangent, across, reach);
#else
    gl_Position = clip * vec4(place.x + across.x * reach, place.y, place.z + across.y * reach, 1.0);
#endif
    vec2 normal = facing + ROUND * across;
    vec3 grass = mix(root[k].rgb, tip[k].rgb, t) * (1.0 + grain_x[k].rgb * normal.x + grain_z[k].rgb * normal.y);
    grass *= place_tone(root_at.xz) * canopy(spine.place.y * height / (root[k].w * lodged(message)), lift(message, root_at));
    color = mix(grass, haze.rgb, haze_at(root_at));
    shown = fade;
}
