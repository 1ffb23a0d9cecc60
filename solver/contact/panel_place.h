// Where a point stands to a panel.
#pragma once

#include <array>

#include "solver/math/types.h"
#include "solver/model/model.h"

namespace topple {

/// Bilinear coordinates r = (r0, r1) of a panel with corners F_0..F_3 at (0, 0), (1, 0), (1, 1), (0, 1):
///   F(r) = sum N_k(r) F_k,
/// and the foot of a point p, where |p - F(r)| is least on the surface, continued beyond the sides.
struct PanelPlace {
  std::array<double, 2> r;
  std::array<double, 4> share;                  ///< N_k
  std::array<std::array<double, 2>, 4> change;  ///< of N_k by r
  std::array<Vec3, 2> along;                    ///< of F by r, m
  Vec3 twist;                                   ///< of F by r0 and r1, m
  Vec3 between;                                 ///< p - F(r), m

  bool within() const { return r[0] > 0 && r[0] < 1 && r[1] > 0 && r[1] < 1; }
  /// Inverse of the second derivatives of |p - F(r)|^2/2 by r, 1/m^2: r moves by it times
  /// sum_k (share_k F'_m + N'_km between) . dx_k.
  Eigen::Matrix2d inverse() const;
  /// Unit, by the order of the corners.
  Vec3 normal() const { return along[0].cross(along[1]).normalized(); }
};
PanelPlace panel_place(const Vec3& p, const std::array<Vec3, 4>& corner);

/// Of the panel within its sides the point that is nearest to p.
struct NearestOnPanel {
  std::array<double, 4> share;  ///< of the corners
  Vec3 between;                 ///< m, from it to p
};
NearestOnPanel nearest_on_panel(const Vec3& p, const std::array<Vec3, 4>& corner);

/// Share of the panel in what a point touches there, and its derivatives by r: 0 on each of the members in
/// it (Panel::members), 1 further than `reach`, m, from all, the product of x^2 (3 - 2 x) between.
struct PanelShare {
  double share;
  std::array<double, 2> change;
};
PanelShare panel_share(const Panel& panel, const PanelPlace& place, double reach);

/// Whether a segment crosses the panel within its sides.
bool crosses_panel(const Vec3& from, const Vec3& to, const std::array<Vec3, 4>& corner);

}  // namespace topple
