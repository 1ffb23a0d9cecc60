// One soft key light with a shadow, and a sky that is brighter above. Colours are linear inside.
uniform vec3 u_eye;
uniform vec3 u_to_key;
uniform mat4 u_shadow_matrix;
uniform sampler2DShadow u_shadow;
uniform sampler2D u_caster;    // 0 where nothing in the map above is near

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

// Shade from the first `taps` of every second place of a square as on a chessboard, black or white, `reach`
// texels of a map of 2048 from the middle to the outermost.
float half_shade(vec3 at, float reach, int white, int taps) {
  const float middle = 0.5 * float(k_shadow_taps - 1);
  float shade = 0.0;
  for (int i = 0; i < taps; ++i) {
    int row = 2 * i / k_shadow_taps, column = 2 * i % k_shadow_taps + (row + white) % 2;
    vec2 offset = (vec2(column, row) - middle) / middle * reach / 2048.0;
    shade += 1.0 - texture(u_shadow, vec3(at.xy + offset, at.z));
  }
  return shade;
}

// Share of the key light that reaches p. Everything outside the map and away from what casts shadows is lit,
// and where the black places agree there is no edge of a shadow: there loops end at once, which spares a
// software rasteriser most of the floor.
float key_visibility(vec3 p, float reach) {
  vec3 at = 0.5 + 0.5 * (u_shadow_matrix * vec4(p, 1.0)).xyz;
  at.z = min(at.z, 1.0);  // what maps of fixed point do by themselves
  bool inside = all(greaterThan(at.xy, vec2(0.0))) && all(lessThan(at.xy, vec2(1.0)));
  bool near = inside && textureLod(u_caster, at.xy, 0.0).r > 0.0;
  float black = half_shade(at, reach, 0, near ? k_half_taps : 0);
  bool edge = black > 0.0 && black < float(k_half_taps);
  float white = half_shade(at, reach, 1, edge ? k_half_taps : 0);
  return 1.0 - (edge ? 0.5 * (black + white) : black) / float(k_half_taps);
}
