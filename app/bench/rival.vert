// One instance is one blade of a tile. One texture holds the blades, three texels each; another holds the chunks of the
// visible tiles, two texels each. A blade bends along a circular arc, by sine waves that travel with the breeze.
#include "lib/light.glsl"

uniform sampler2D blades;
uniform sampler2D chunks;
uniform int first;    // index of this level's first chunk
uniform int many;     // number of blades in a tile
uniform float full;   // distance up to which every blade is drawn [m]
uniform float now;    // time [s]
uniform vec4 breeze;  // direction x, z; strength; gustiness
uniform float speed;  // of the breeze's waves [m/s]

out vec3 color;

const float WAVE = 0.45;   // wavenumber of the breeze [rad/m]
const float CURL = 2.5;    // angle of the arc of a blade that lies flat [rad]
const float ROUNDED = 0.35;
const vec2 DRIFTS = vec2(0.6, 0.4);  // amplitudes of the two waves of gustiness
const vec2 SKEWED = vec2(0.2, -0.5);  // their wavenumbers across the breeze [rad/m]
const float SHORTER = 1.7;  // wavenumber of the second wave, relative to the first
const vec2 BEAT = vec2(8.0, 6.0);  // angular frequencies of a blade's own swing, along x and z [rad/s]
const vec2 APART_X = vec2(7.0, 0.0), APART_Z = vec2(3.0, 9.0);  // change of the swing's phase over the ground [rad/m]
const float OWN = 0.25;  // amplitude of the swing, relative to the breeze

vec4 texel(sampler2D from, int number) {
    return texelFetch(from, ivec2(number % WIDTH, number / WIDTH), 0);
}

vec2 swayed(vec2 place) {
    float along = WAVE * (dot(place, breeze.xy) - speed * now), aside = dot(place, vec2(-breeze.y, breeze.x));
    float drift = dot(DRIFTS, sin(along * vec2(1.0, SHORTER) + aside * SKEWED));
    vec2 own = sin(BEAT * now + APART_X * place.x + APART_Z * place.y);
    return (breeze.xy * (1.0 + breeze.w * drift) + OWN * own) * breeze.z;
}

vec3 light(int k, float t, vec2 normal, vec3 place, float h, vec2 bent) {
    Lie lies = lie_at(place.xz);
    vec3 grass = pigment_at(k, t) * azimuth_tint(k, doubled_angle(normal));
    Light reaches = hazed(leaf_light(k, bent, place, lies, density_at(place.xz)), place);
    return tone_mapped(shade(leaf_surface(grass * dryness_tint(lies.slow), h), reaches));
}

void main() {
    int chunk = 2 * (first + gl_InstanceID / CHUNK);
    vec4 tile = texel(chunks, chunk), corners = texel(chunks, chunk + 1);
    int number = min(int(tile.w) + gl_InstanceID % CHUNK, many - 1);
    int base = 3 * (int(tile.z) * many + number);
    vec4 stem = texel(blades, base), lean = texel(blades, base + 1), sort = texel(blades, base + 2);
    vec2 part = stem.xy / patch_side;
    float ground = mix(mix(corners.x, corners.y, part.x), mix(corners.z, corners.w, part.x), part.y);
    vec3 foot = vec3(tile.x + stem.x, ground, tile.y + stem.y);
    float share = min(full / distance(foot, eye), 1.0);
    int k = int(sort.x);
    color = vec3(0.0);
    gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
    if (sort.y >= share * density_at(foot.xz, k) || int(tile.w) + gl_InstanceID % CHUNK >= many)
        return;
    float t = float(gl_VertexID / 2) / float(SEGMENTS);
    vec2 message = swayed(foot.xz);
    vec2 bend = message + lean.xy * (1.0 - min(length(message), 1.0));
    float angle = max(CURL * min(length(bend), 1.0), LEAST_PART);
    vec2 spine = vec2(1.0 - cos(angle * t), sin(angle * t)) / angle * stem.z;
    vec2 across = vec2(-lean.w, lean.z) * (float(gl_VertexID % 2) * 2.0 - 1.0);
    float h = spine.y / (OF(crown, k) * lodged(message));
    color = light(k, t, lean.zw + ROUNDED * across, foot, h, message);
    across *= 0.5 * stem.w / share * pow(1.0 - t, kinds[k].taper);
    vec2 over = normalize(bend + LEAST_LENGTH) * spine.x + across;
    gl_Position = clip * vec4(foot.x + over.x, foot.y + spine.y, foot.z + over.y, 1.0);
}
