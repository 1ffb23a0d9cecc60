in vec3 v_position;
in vec3 v_normal;
in vec2 v_uv;
uniform vec3 u_eye;
out vec4 o_colour;

void main() {
  vec3 to_eye = normalize(u_eye - v_position);
  float grazing = 1.0 - abs(dot(normalize(v_normal), to_eye));
  vec2 pixel = fwidth(v_uv);
  vec2 away = min(v_uv, 1.0 - v_uv) / max(pixel, vec2(1e-6));
  float border = 1.0 - smoothstep(0.5, 1.5, min(away.x, away.y));
  float sheen = pow(grazing, 3.0);
  vec3 glass = mix(vec3(0.52, 0.62, 0.72), vec3(0.86, 0.90, 0.94), sheen);
  o_colour = vec4(mix(glass, vec3(0.36, 0.45, 0.54), border), mix(0.15 + 0.20 * sheen, 0.50, border));
}
