// Shadow maps: of the key light, and of contact with the floor.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "render/gl/gl.h"
#include "render/gl/gl_objects.h"
#include "render/scene/mesh.h"

namespace topple::render {

/// The floor on which bodies throw contact shadows.
struct FloorPlane {
  Eigen::Vector3f point{0, 0, 0};  ///< m
  Eigen::Vector3f along{1, 0, 0};  ///< unit, with `across` and `normal` a right-handed frame
  Eigen::Vector3f across{0, 1, 0};
  Eigen::Vector3f normal{0, 0, 1};
};

/// Texels along the sides of the maps.
struct ShadowSize {
  int key;
  int contact;
  int shade;  ///< of contact, once for each place on the floor
};

/// The maps and what shaders need to read them. `gl` must outlive them.
class Shadows {
 public:
  /// constants: shader that says how finely it is shaded (look_*.glsl).
  Shadows(const Gl& gl, std::string_view constants, const ShadowSize& size);

  /// Draws both maps of what `draw_solids` draws: `solids`, which lie in the box low..high.
  void draw(const Eigen::Vector3f& low, const Eigen::Vector3f& high, const FloorPlane& floor,
            const Mesh& solids, const std::function<void()>& draw_solids);

  /// False where light reaches all of the flat piece with these corners.
  bool may_fall_on(const std::array<Eigen::Vector3f, 4>& places) const;

  /// Unit vector towards the key light.
  static const Eigen::Vector3f& to_key();

  /// Binds the maps to their texture units.
  void bind() const;
  /// Sets the uniforms of light.glsl and ground.frag that concern the maps; the program is in use.
  void set(const Program& program) const;

 private:
  void set_up_key(const Eigen::Vector3f& low, const Eigen::Vector3f& high);
  void set_up_contact(const Eigen::Vector3f& low, const Eigen::Vector3f& high, const FloorPlane& floor);
  /// What lies higher over the floor does not count, m.
  struct Highest {
    const FloorPlane& floor;
    float height;
  };
  /// 255 in the boxes of triangles on a coarse map, by rows from the corner; else 0. to_map makes -1..1 of
  /// the map; margin: around them, of its side.
  static std::vector<std::uint8_t> marked(const Eigen::Matrix4f& to_map, float margin, const Highest& highest,
                                          const Mesh& solids);
  /// Whether anything is marked in the box of `places`.
  static bool any_marked(const std::vector<std::uint8_t>& marked, const Eigen::Matrix4f& to_map,
                         const std::array<Eigen::Vector3f, 4>& places);
  void shade_contact();

  const Gl& gl_;
  ShadowSize size_;
  Program key_program_, contact_program_, shade_program_;
  GlObject key_map_, contact_map_, near_map_, shade_map_, key_target_, contact_target_, shade_target_,
      empty_array_;
  std::vector<std::uint8_t> near_, casters_;  // marked: what is near the floor; what casts shadows
  float nearest_to_light_ = 0;                // of what casts shadows, m along the light
  Eigen::Matrix4f key_matrix_ = Eigen::Matrix4f::Identity();
  Eigen::Matrix4f contact_matrix_ = Eigen::Matrix4f::Identity();
  float contact_width_ = 1;  // m, side of the square that is mapped
};

}  // namespace topple::render
