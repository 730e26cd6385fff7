// The sky's light along a line of sight, without and with clouds.
#include "lib/clouds.glsl"
#include "lib/light.glsl"

uniform sampler2D sky;     // sky map: by azimuth from the sun, 0 to pi, and by the root of the elevation's sine
uniform sampler2D clouds;  // picture of clouds: opacity; sunlight of lit sides and scattered light that they send; opacity before the sun

const float PI = 3.14159;
const vec3 ARC = vec3(1.5707, -0.2121, 0.0742);  // arc cosine over the root of 1 - c, as a polynomial in c (Hastings, 1955)

// Arc cosine in [0, pi], with a relative error of 0.004; acos() is slower.
float angle_of(float cosine) {
    float c = abs(cosine), near = sqrt(1.0 - c) * (ARC.x + c * (ARC.y + c * ARC.z));
    return cosine < 0.0 ? PI - near : near;
}

// Radiance of the sky in a direction, without clouds; below the horizon it is that of haze, whose azimuth counts the less the
// steeper one looks.
vec3 sky_toward(vec3 toward) {
    float level = toward.y > 0.0 ? dot(toward.xz, toward.xz) : 1.0, c = dot(toward.xz, toward_sun) * inversesqrt(level + LEAST_LENGTH);
    vec2 size = vec2(textureSize(sky, 0)), place = vec2(angle_of(clamp(c, -1.0, 1.0)) / PI, sqrt(max(toward.y, 0.0)));
    return textureLod(sky, (place * (size - 1.0) + 0.5) / size, 0.0).rgb;
}

// How far clouds stand out from the haze, 0 to 1, by the sine of the elevation.
float out_of_haze(float sine) {
    return smoothstep(CLOUD_FADE.x, CLOUD_FADE.y, sine);
}

// Radiance of the sky with a texel of the picture of clouds before it, without the sunlight of their lit sides.
vec3 clouds_before(vec3 seen, vec4 cloud) {
    return seen + cloud.x * (groundlight - seen) + cloud.z * (cloudlight - groundlight);
}
