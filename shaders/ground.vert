layout(location = 0) in vec2 a_plane;
uniform mat4 u_view_projection;
uniform vec3 u_centre;
uniform vec3 u_along;
uniform vec3 u_across;
out vec3 v_position;
out vec2 v_plane;

void main() {
  v_plane = a_plane;
  v_position = u_centre + v_plane.x * u_along + v_plane.y * u_across;
  gl_Position = u_view_projection * vec4(v_position, 1.0);
}
