// What the corners of a far tree's picture tell its pixels.
PASSED vec3 on;                 // position on its picture, each way from 0 to 1, or across a row, with CAST of half its height; height over its foot,
                                // of the tree's
flat PASSED vec4 tile_corners;  // corners of the mixed pictures in their texture, the first and the second
flat PASSED vec2 mix_shares;    // share of the second
flat PASSED vec4 motion;        // its random number; amplitude of its limbs and displacement of its top, relative to its picture; mip level
flat PASSED vec2 row_of_trees;  // number of trees in a row; distance between them, relative to a picture
flat PASSED float texel_side;   // size of the coarser texels that are read, relative to a picture
#ifdef CAST
flat PASSED vec4 cast_shade;  // radius of its shade, of half its picture; optical depth in the middle; 1 in the map from above; position along the
                              // sun's rays [m]
flat PASSED vec3 foot_shade;  // radius of its foot's shade; optical depth there; its foliage
#else
flat PASSED vec4 sun_weights;     // weights of the pictures' optical depths for the sun, along its axes and in all
flat PASSED vec4 ray_weights;     // and for the ray from the eye behind what is seen, with all its leaves
PASSED vec4 sun_radiance;         // radiance of its leaves under the sun; opacity
PASSED vec4 wood_gain;            // what its wood has more; radius that THICKEST stands for, on it [m]
flat PASSED vec4 sky_radiance;    // radiance of the sky; mean of its leaves' normals' y
flat PASSED vec3 below;
flat PASSED vec3 haze_colour;
flat PASSED vec3 old_pigment;     // mean pigment of its old bark
flat PASSED vec2 picture_texels;  // size of its pictures, across and up [texels]
flat PASSED float finer_texel;     // size of its finest texels, relative to the coarser ones that are read
flat PASSED float rugged;         // part of the detail of its bark that shows in these
flat PASSED vec2 limb_phases;     // phases of its limbs' swing, along and across its picture [rad]
flat PASSED vec3 clump_progress;  // progress of clumps of leaves from the first picture to the second, both ways, and their spread
flat PASSED float grass_scale;    // its height, relative to that of the grass about its foot
#endif
