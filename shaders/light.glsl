// One soft key light with a shadow, and a sky that is brighter above. Colours are linear inside.
uniform vec3 u_eye;
uniform vec3 u_to_key;
uniform mat4 u_shadow_matrix;
uniform sampler2DShadow u_shadow;

const vec3 k_key_colour = vec3(1.0, 0.985, 0.96);

vec3 linear_of(vec3 coded) {
  return mix(coded / 12.92, pow((coded + 0.055) / 1.055, vec3(2.4)), step(0.04045, coded));
}

vec3 coded_of(vec3 colour) {
  vec3 c = clamp(colour, 0.0, 1.0);
  return mix(c * 12.92, 1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, step(0.0031308, c));
}

vec3 sky_light(vec3 normal) {
  return mix(vec3(0.36, 0.355, 0.35), vec3(0.56, 0.575, 0.59), 0.5 + 0.5 * normal.z);
}

const int k_half_taps = k_shadow_taps * k_shadow_taps / 2;

float lit(vec3 at, vec2 texels) {  // of a map of 2048
  return texture(u_shadow, vec3(at.xy + texels / 2048.0, at.z));
}

// Where p is in the map; everything outside of it is lit.
vec3 on_shadow_map(vec3 p) {
  vec3 at = 0.5 + 0.5 * (u_shadow_matrix * vec4(p, 1.0)).xyz;
  at.z = min(at.z, 1.0);  // what maps of fixed point do by themselves
  return at;
}

// Share of the key light that reaches p on a narrow thing: four places, each between four texels.
float narrow_key_visibility(vec3 p) {
  if (!k_shaded) return 1.0;
  vec3 at = on_shadow_map(p);
  return 0.25 * (lit(at, vec2(-1.0, -1.0)) + lit(at, vec2(1.0, -1.0)) + lit(at, vec2(-1.0, 1.0)) + lit(at, vec2(1.0, 1.0)));
}

// Shade from the first `taps` of every second place of a square as on a chessboard, black or white, `reach`
// texels from the middle to the outermost.
float half_shade(vec3 at, float reach, int white, int taps) {
  const float middle = 0.5 * float(k_shadow_taps - 1);
  float shade = 0.0;
  for (int i = 0; i < taps; ++i) {
    int row = 2 * i / k_shadow_taps, column = 2 * i % k_shadow_taps + (row + white) % 2;
    shade += 1.0 - lit(at, (vec2(column, row) - middle) / middle * reach);
  }
  return shade;
}

// The same on a floor or wall, with an edge as soft as `reach`. Where the black places agree there is no edge
// of a shadow: there the loop ends at once, which spares a software rasteriser half of it.
float wide_key_visibility(vec3 p, float reach) {
  if (!k_shaded) return 1.0;
  vec3 at = on_shadow_map(p);
  float black = half_shade(at, reach, 0, k_half_taps);
  bool edge = black > 0.0 && black < float(k_half_taps);
  float white = half_shade(at, reach, 1, edge ? k_half_taps : 0);
  return 1.0 - (edge ? 0.5 * (black + white) : black) / float(k_half_taps);
}
