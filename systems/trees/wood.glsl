// What the vertices of bark tell its pixels.
PASSED vec2 bark_at;
PASSED vec3 facing;
PASSED vec3 seen_at;
#ifdef BAKED
PASSED vec4 inside;
#else
PASSED vec3 sun_radiance;  // radiance of mean bark that faces the sun, and of the sky's light; above the grass
PASSED vec3 sky_radiance;
flat PASSED vec3 haze_colour;
#endif
PASSED float stem_cover;      // coverage
flat PASSED float ribbon;     // 1 on a ribbon, which is shaded as if round
PASSED vec2 edge;             // softness of its edges; position of the vertex, relative to the stem's edge
PASSED float age;             // age of its bark, 0 to 1; or radius of the stem, of THICKEST
PASSED float grass_height;    // height over the ground, relative to the grass's
flat PASSED vec2 grass_here;  // leaf area of that grass; its extinction of sunlight
