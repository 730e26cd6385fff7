// One instance per body. With BORDER, only a border one pixel wide along the silhouette, which fades outwards.
#include "lib/light.glsl"

in vec3 place;   // in the body's local axes: x right, y up, -z ahead
in vec3 normal;
in float part;
in vec3 middle;  // the body's position and axes in the world
in vec3 right;
in vec3 up;
in vec3 back;
#ifdef BORDER
in vec3 other;   // other end of the edge
in vec3 side;    // normals of the edge's two triangles
in vec3 beyond;
in float outside;
#endif

const float NEAREST = 0.15;  // distance from the eye below which a body has no border [m]

out vec3 local;
out vec3 world_place;
out vec3 world_normal;
flat out float material;
out float cover;

void main() {
    mat3 axes = mat3(right, up, back);
    local = place;
    world_place = middle + axes * place;
    world_normal = axes * normal;
    material = part;
    cover = 1.0;
    gl_Position = clip * vec4(world_place, 1.0);
#ifdef BORDER
    vec3 ray = transpose(axes) * (eye - middle) - place;
    vec4 far = clip * vec4(middle + axes * other, 1.0);
    if (dot(ray, side) * dot(ray, beyond) > 0.0 || min(far.w, gl_Position.w) < NEAREST) {
        gl_Position = vec4(0.0, 0.0, 2.0, 1.0);
        return;
    }
    vec2 here = gl_Position.xy / gl_Position.w;
    vec2 run = (far.xy / far.w - here) * half_screen;
    vec2 aside = vec2(-run.y, run.x) / max(length(run), LEAST_LENGTH);
    vec4 away = clip * vec4(axes * (side + beyond), 0.0);
    aside *= sign(dot(aside, (away.xy - here * away.w) * half_screen));
    gl_Position.xy += outside * aside / half_screen * gl_Position.w;
    cover = 1.0 - outside;
#endif
}
