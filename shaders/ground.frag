in vec3 v_position;
in vec2 v_plane;
uniform vec2 u_half;
uniform vec3 u_normal;
uniform vec2 u_grid_origin;    // in plane coordinates
uniform vec3 u_focus;          // middle of the bodies
uniform float u_fade_radius;
uniform float u_line_width;    // pixels
uniform float u_strength;      // 1, or little where the ground is seen from behind
uniform float u_is_floor;
uniform int u_dark;
uniform vec4 u_wall;            // plane of the wall behind which the floor ends: normal, offset
uniform mat4 u_contact_matrix;
uniform sampler2D u_contact;    // contact_shade.frag
out vec4 o_colour;

// Cover of a square grid of lines, 0..1: as wide as a pixel allows, gone where lines would merge.
float grid(vec2 p, float spacing, float width) {
  vec2 pixel = fwidth(p);
  vec2 away = abs(fract(p / spacing - 0.5) - 0.5) * spacing;
  vec2 line = 1.0 - smoothstep(0.5 * (width - 1.0) * pixel, 0.5 * (width + 1.0) * pixel, away);
  line *= 1.0 - smoothstep(0.12, 0.4, pixel / spacing);
  return max(line.x, line.y);
}

// Shade where bodies touch or nearly touch the floor.
float contact_shade(vec3 p) {
  vec2 at = 0.5 + 0.5 * (u_contact_matrix * vec4(p, 1.0)).xy;
  bool inside = all(greaterThan(at, vec2(0.0))) && all(lessThan(at, vec2(1.0)));
  return inside ? textureLod(u_contact, at, 0.0).r : 1.0;
}

// A colour in less light: coded_of(linear_of(coded) * shade), but for rounding, with one power instead of six.
vec3 shaded(vec3 coded, float shade) {
  return (coded + 0.055) * pow(shade, 1.0 / 2.4) - 0.055;
}

void main() {
  vec2 edge = v_plane / u_half;
  float above = v_plane.y + u_half.y;
  if (u_is_floor < 0.5) edge.y = max(edge.y, 0.0);   // a wall stands on the floor: no fading below
  vec2 inside = 1.0 - smoothstep(0.60, 1.0, abs(edge));
  float fade = inside.x * inside.y;
  fade *= u_is_floor > 0.5 ? smoothstep(-0.25, 0.0, dot(u_wall.xyz, v_position) - u_wall.w)
                           : clamp(above / fwidth(above), 0.0, 1.0);
  fade *= 1.0 - smoothstep(0.45, 1.0, distance(v_position, u_focus) / u_fade_radius);

  vec2 p = v_plane - u_grid_origin;
  float lines = max(0.075 * grid(p, 0.1, u_line_width), 0.24 * grid(p, 1.0, 1.5 * u_line_width));
  vec3 paint = u_dark == 1 ? vec3(0.285, 0.300, 0.320) : u_is_floor > 0.5 ? vec3(0.925, 0.925, 0.92) : vec3(0.915, 0.925, 0.935);
  vec3 colour = paint;
  if (k_shaded) {
    float shade = mix(0.66, 1.0, wide_key_visibility(v_position + 0.002 * u_normal, 5.0));
    if (u_is_floor > 0.5) shade *= contact_shade(v_position);
    if (shade < 1.0) colour = shaded(paint, shade);
  }
  colour = mix(colour, u_dark == 1 ? vec3(0.74, 0.79, 0.84) : vec3(0.30, 0.36, 0.43), lines);
  o_colour = vec4(colour, fade * u_strength);
}
