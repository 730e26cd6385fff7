#include "lib/light.glsl"

in vec3 place;
in vec3 soil_color;
in float veiled;

out vec4 pixel;

#ifdef CARPET
#include "lib/random.glsl"
#include "lib/shares.glsl"

uniform sampler2DArray images;  // place along the blade, height, normal, coverage; premultiplied
uniform float slopes[SLOPES];
uniform vec4 first;             // by kind: first layer of the images
uniform ivec2 stock;            // patch models; seed

in float carpet;
in vec2 rise;
in float fuzz;
uniform vec4 bowed;  // by kind: height of grass in the wind of now, of that at rest
uniform vec4 leaf;    // by kind: leaf area seen from the side, of the ground's area
uniform float blown;  // mean posture index of now

vec2 spun(vec2 v, int turns) {
    return turns == 0 ? v : turns == 1 ? vec2(-v.y, v.x) : turns == 2 ? -v : vec2(v.y, -v.x);
}

// What a ray that meets the carpet here sees of one kind: blended between the nearest images by viewing angle.
vec4 carpet_image(float layer, vec2 at, vec2 heading, float slope, vec2 dx, vec2 dy) {
    int low = 0;
    for (int i = 1; i < SLOPES - 1; i++)
        low = slope >= slopes[i] ? i : low;
    float part = clamp((slope - slopes[low]) / (slopes[low + 1] - slopes[low]), 0.0, 1.0);
    vec2 share = heading * heading;
    float across = layer + float(low * 4) + (heading.x > 0.0 ? 1.0 : 3.0);
    float along = layer + float(low * 4) + (heading.y > 0.0 ? 2.0 : 0.0);
    vec4 near = share.x * textureGrad(images, vec3(at, across), dx, dy) + share.y * textureGrad(images, vec3(at, along), dx, dy);
    vec4 steep = share.x * textureGrad(images, vec3(at, across + 4.0), dx, dy)
               + share.y * textureGrad(images, vec3(at, along + 4.0), dx, dy);
    return mix(near, steep, part);
}

float viewing_slope() {
    vec3 ray = place - eye.xyz;
    return (dot(rise, ray.xz) - ray.y) / max(length(ray.xz), 1e-4);
}

// How much of what a line of sight meets is of each kind: taller kinds hide the others at a low angle. The grass is
// taken in four layers from the top; its leaf area falls off linearly with height.
vec4 kinds_met(vec4 grows, float slope) {
    float top = 0.0;
    for (int kind = 0; kind < KINDS; kind++)
        top = max(top, grows[kind] > 0.004 ? root[kind].w : 0.0);
    vec4 met = vec4(0.0);
    float through = 1.0;
    for (int layer = 0; layer < 4; layer++) {
        float height = top * (0.875 - 0.25 * float(layer));
        vec4 stop = vec4(0.0);
        for (int kind = 0; kind < KINDS; kind++) {
            float canopy_height = root[kind].w;
            stop[kind] = grows[kind] * leaf[kind] * 2.0 * max(1.0 - height / canopy_height, 0.0) * top / canopy_height;
        }
        float sum = dot(stop, vec4(1.0));
        float stopped = through * (1.0 - exp(-0.25 * sum / slope));
        met += stopped * stop / max(sum, 1e-6);
        through -= stopped;
    }
    return met / max(dot(met, vec4(1.0)), 1e-6);
}

vec3 carpet_light(float slope) {
    ivec2 cell = ivec2(floor(place.xz / soil.w));
    uint drawn = hash3(stock.y, cell.x, cell.y);
    int model = int(drawn % uint(stock.x)), turn = int((drawn >> 16u) % 4u);
    vec2 at = spun(place.xz / soil.w - vec2(cell) - 0.5, (4 - turn) % 4) + 0.5;
    vec2 dx = spun(dFdx(place.xz), (4 - turn) % 4) / soil.w, dy = spun(dFdy(place.xz), (4 - turn) % 4) / soil.w;
    vec3 ray = place - eye.xyz;
    vec2 heading = ray.xz / max(length(ray.xz), 1e-4);
    vec4 grows = textureLod(density, on_map(place.xz), 0.0);
    vec4 met = kinds_met(grows, max(slope, slopes[0])) * min(dot(grows, vec4(1.0)), 1.0);
    float lifted = lift(vec2(blown, 0.0), place);
    vec3 here = place_tone(place.xz);
    vec4 sum = vec4(0.0);
    for (int kind = 0; kind < KINDS; kind++) {
        if (grows[kind] < 0.004)
            continue;
        float layer = first[kind] + float(model * SLOPES * 4);
        vec4 image = carpet_image(layer, at, spun(heading, (4 - turn) % 4), max(slope, slopes[0]), dx, dy);
        vec3 grass = root[kind].rgb * image.a + (tip[kind].rgb - root[kind].rgb) * image.r;
        float h = bowed[kind] * image.g / max(image.a, 1e-3);
        sum += met[kind] * vec4(grass * here * canopy(h, lifted), image.a);
    }
    return sum.rgb + soil_color * (1.0 - min(sum.a, 1.0));
}

#endif

void main() {
    vec3 color = soil_color;
    float covered = 1.0;
#ifdef CARPET
    float slope = viewing_slope();
    float share = carpet > 0.0 ? share_at(ivec2(floor(place.xz / soil.w))) : 0.0;
    color = mix(color, carpet_light(slope), share);
    // Near an outline the slope falls like the root of the distance to it on the screen: which gives that distance,
    // over which single tips let through what is behind them.
    float below = 0.5 * max(slope, 0.0) / max(length(vec2(dFdx(slope), dFdy(slope))), 1e-6);
    float tips = fuzz * screen.z / distance(place, eye.xyz);
    covered = mix(1.0, clamp(below / max(tips, 1.0), 0.0, 1.0), share);
    if (covered < 0.004)
        discard;
#endif
    pixel = vec4(mix(color, haze.rgb, veiled), 1.0) * covered;
}
