// One instance is one blade: a ribbon of SEGMENTS quads. With SOFT it is drawn half a pixel wider on either side, and the
// fragments say how much of each pixel it covers; so a blade thinner than a pixel is faint, and not a row of dots. With
// MORPH it is on its way between its own place and its painted place on a moving strip (paper, section 4.2).
#include "lib/light.glsl"
#include "lib/posture.glsl"

in vec3 root_at;
in float height;
in vec2 rest;
in vec2 facing;
in float width;
in float variant;
in float kind;
in float stem;  // height of the one that it stands on [m]
in vec2 message;
in float fade;
#ifndef MORPH
in float slide;      // of the joints, to those of a coarser blade
uniform float near;  // distance up to which blades hide one another by depth [m]; beyond it order alone says
#else
#include "lib/painted.glsl"

in float morph;    // how far it has moved
in float edge;     // first edge of its strip
in float painted;  // its row of the targets
uniform vec4 tall; // by kind: height of the strips [m]
#endif

out vec3 color;
flat out float shown;
#ifdef SOFT
noperspective out float aside;  // from the middle line [pixel]
noperspective out float half_width;  // of the ribbon [pixel]
flat out float hides;  // coverage from which on a pixel counts as hidden behind it
uniform int part;      // 0: all of it; 1: where it hides what is behind it; 2: the rest

// Move a point aside on the screen, so that the ribbon reaches half a pixel beyond its edge.
vec4 widened(vec3 place, vec3 tangent, vec2 across) {
    vec4 middle = clip * vec4(place, 1.0);
    vec4 edge = clip * vec4(across.x, 0.0, across.y, 0.0);
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

vec3 light(int k, float t, vec2 normal, vec3 place, float h, vec2 bent) {
    vec3 grass = mix(root[k].rgb, tip[k].rgb, t) * (1.0 + grain_x[k].rgb * normal.x + grain_z[k].rgb * normal.y);
    grass *= place_tone(place.xz) * canopy(h, lift(bent, place));
    return mix(grass, haze.rgb, haze_at(place));
}

void main() {
#if defined(MORPH)
    hides = 2.0;
#elif defined(SOFT)
    hides = mix(0.5, 2.0, smoothstep(0.8 * near, near, distance(root_at.xz, eye.xz)));
    if (part == 1 && hides > 1.0) {
        gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
        color = vec3(0.0);
        aside = half_width = shown = 0.0;
        return;
    }
#endif
    float t = float(gl_VertexID / 2) / float(SEGMENTS);
#ifndef MORPH
    t = mix(t, floor(t * float(COARSER) + 0.5) / float(COARSER), slide);
#endif
    float side = float(gl_VertexID % 2) * 2.0 - 1.0;
    int k = int(kind);
    vec2 bend = message + rest * (1.0 - min(length(message), 1.0));
    Spine spine = posture(variant, bend, t);
    vec3 foot = stem > 0.0 ? posture(float(k) * field.w, message, 1.0).place * stem : vec3(0.0);
    vec3 place = root_at + foot + spine.place * height, tangent = spine.tangent * height;
    vec2 across = vec2(-facing.y, facing.x) * side;
    float reach = 0.5 * width * pow(max(1.0 - t, 0.0), tip[k].w);
    float h = (foot.y + spine.place.y * height) / (root[k].w * lodged(message));
    float ripe = stem > 0.0 ? 1.0 : t;
    color = light(k, ripe, facing + ROUND * across, root_at, h, message);
    across *= reach;
#ifdef MORPH
    Painted target = painted_at(int(edge), int(painted), t, k, tall[k]);
    vec2 run = normalize(target.run.xz);
    place = mix(place, target.place, morph);
    tangent = mix(tangent, target.tangent, morph);
    across = mix(across, run * dot(run, across) * boosted(run, target.middle), morph);
    vec2 off = vec2(-run.y, run.x);  // a strip knows but the normals across it
    color = mix(color, light(k, ripe, off * dot(off, facing), target.middle, target.h, target.message), morph);
#endif
#ifdef SOFT
    gl_Position = widened(place, tangent, across);
#else
    gl_Position = clip * vec4(place.x + across.x, place.y, place.z + across.y, 1.0);
#endif
    shown = fade;
}
