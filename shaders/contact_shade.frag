// Light that is left on the floor where bodies touch or nearly touch it, over the square that is mapped.
in vec2 v_at;
uniform float u_contact_size;  // m, side of the square
uniform sampler2D u_contact;   // contact.frag
uniform sampler2D u_near;      // 0 where that is empty as far as shade reaches
out float o_light;

vec2 nearness(vec2 at, vec2 offset, float radius) {
  float level = log2(max(radius * float(textureSize(u_contact, 0).x) / u_contact_size, 1.0));
  if (!k_fine) level = round(level);  // one level to read instead of two
  return textureLod(u_contact, at + offset / u_contact_size, level).rg;
}

void main() {
  int taps = texture(u_near, v_at).r > 0.0 ? k_contact_taps : 0;
  float tight = 0.0;
  float wide = 0.0;
  for (int i = 0; i < taps; ++i) {
    float angle = 6.283184 / float(k_contact_taps) * float(i);
    vec2 direction = vec2(cos(angle), sin(angle));
    if (k_fine) {
      // As far as it can be seen from low above the floor, where depth is foreshortened.
      tight += 0.4 * nearness(v_at, 0.014 * direction, 0.014).r + 0.6 * nearness(v_at, 0.050 * direction, 0.042).r;
      wide += 0.6 * nearness(v_at, 0.030 * direction, 0.030).g + 0.4 * nearness(v_at, 0.075 * direction, 0.060).g;
    } else {
      vec2 near = nearness(v_at, 0.036 * direction, 0.036);
      tight += near.r;
      wide += near.g;
    }
  }
  tight /= float(k_contact_taps);
  wide /= float(k_contact_taps);
  // A beam covers little of its surroundings, and yet its foot must be seen: small covers count more.
  tight = 1.0 - pow(1.0 - tight, 5.0);
  wide = 1.0 - (1.0 - wide) * (1.0 - wide);
  o_light = (1.0 - 0.82 * tight) * (1.0 - 0.26 * wide);
}
