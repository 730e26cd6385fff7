#include "lib/light.glsl"

uniform sampler2D sky;  // by azimuth from the sun, from 0 to pi, and by the root of the elevation's sine

in vec3 ray;
out vec4 pixel;

const float LIMB = 0.00483;  // sine of the outer edge of the sun's disc, which is 0.53 degrees wide half-way up its limb
const float DISC = 12.0;     // radiance of the sun's disc, of a white leaf's in full sun: far above white

// An angle in [0, pi] by its cosine, within 0.004 of itself; acos is dearer.
float angle_of(float cosine) {
    float c = abs(cosine), near = sqrt(1.0 - c) * (1.5707 - 0.2121 * c + 0.0742 * c * c);
    return cosine < 0.0 ? 3.14159 - near : near;
}

// Clouds as they are seen from below: they take from the sky, and are bright about the sun.
vec3 clouded(vec3 light, vec3 toward) {
    vec2 at = eye.xz + toward.xz * (CLOUDS_AT / max(toward.y, 0.02));
    float dense = smoothstep(1.0 - sunlight.w, 1.45 - sunlight.w, textureLod(repeating, at / CLOUDS_SIDE - drift.xy, 0.0).r);
    dense *= smoothstep(0.02, 0.16, toward.y);
    float ahead = 0.5 + 0.5 * dot(toward, sun.xyz);
    vec3 lit = skylight.rgb * 1.1 + sunlight.rgb * (0.42 - 0.22 * dense + 0.5 * ahead * ahead * ahead * (1.0 - dense));
    return mix(light, lit, 0.9 * dense);
}

void main() {
    vec3 toward = normalize(ray);
    vec3 level = haze_light(eye.xyz + toward);
    float aside = dot(toward, sun.xyz) > 0.0 ? length(cross(toward, sun.xyz)) : 1.0;  // near 1, cosines are too coarse
    vec3 light = level;
    if (toward.y > 0.0) {
        float c = dot(toward.xz, drift.zw) * inversesqrt(dot(toward.xz, toward.xz) + 1e-6);
        vec2 size = vec2(textureSize(sky, 0)), at = vec2(angle_of(clamp(c, -1.0, 1.0)) / 3.14159, sqrt(toward.y));
        light = textureLod(sky, (at * (size - 1.0) + 0.5) / size, 0.0).rgb;
        light = mix(level, light, smoothstep(0.0, 0.06, toward.y));
        if (sunlight.w > 0.0)
            light = clouded(light, toward);
        light += sunlight.rgb * (DISC * smoothstep(LIMB, LIMB - 0.0004, aside) + 0.35 * exp2(-50.0 * aside));
    }
    vec3 shown = shown_of(light);
    float grit = fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715)))) - 0.5;
    pixel = vec4(shown + (sun.w > 0.5 ? 0.0 : grit / 255.0), 1.0);
}
