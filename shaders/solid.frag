in vec3 v_position;
in vec3 v_normal;
in float v_at;
flat in vec4 v_colour;
uniform sampler2D u_colour_map;
out vec4 o_colour;

void main() {
  // Half a texel in, so that the ends of the map are its own end colours.
  float at = (v_at * 255.0 + 0.5) / 256.0;
  vec3 coded = v_colour.a > 0.0 ? v_colour.rgb : texture(u_colour_map, vec2(at, 0.5)).rgb;
  vec3 normal = normalize(v_normal);
  vec3 to_eye = normalize(u_eye - v_position);
  float shade = narrow_key_visibility(v_position + 0.004 * normal);
  float key = k_shaded ? max(dot(normal, u_to_key), 0.0) * shade : 0.0;
  vec3 light = sky_light(normal) + 0.66 * key * k_key_colour;
  float rim = pow(1.0 - max(dot(normal, to_eye), 0.0), 4.0) * (0.5 + 0.5 * normal.z);
  float gloss = k_shaded ? pow(max(dot(normal, normalize(to_eye + u_to_key)), 0.0), 40.0) * shade : 0.0;
  vec3 colour = linear_of(coded) * light + vec3(0.10 * rim + 0.06 * gloss);
  o_colour = vec4(coded_of(colour), 1.0);
}
