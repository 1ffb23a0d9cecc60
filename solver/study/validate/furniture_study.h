// Furniture values of the Japanese evaluation method against ensembles of planar blocks.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "solver/model/accelerogram.h"
#include "solver/study/overturn/fragility.h"

namespace topple::study {

/// A piece as the method has it.
struct FurnitureValue {
  std::string name;
  double lift = 0;    ///< A_0, m/s^2: g B/H
  double median = 0;  ///< A_R50, m/s^2, below the corner frequency
  double height = 0;  ///< m, H

  double slenderness() const;  ///< B/H
  double corner() const;       ///< Hz, F_b (criteria.h)
  /// m/s^2, under a floor of this frequency: A_R50, above the corner times frequency over F_b.
  double median_at(double frequency) const;
};

/// The five that are quoted from the method (NILIM); their heights are assumed here, the method's A_R50 does
/// not depend on them.
const std::vector<FurnitureValue>& furniture_values();
/// Those of furniture.csv in a folder: name,a0_gal,ar50_gal,height_m. Throws io::InputError.
std::vector<FurnitureValue> read_furniture(const std::filesystem::path& folder);

/// A point of the comparison: a piece under floors of one frequency.
struct FurniturePoint {
  std::size_t piece = 0;
  double ratio = 0;     ///< frequency of the floor over F_b
  double friction = 0;  ///< k_rough: does not slip
};
/// All: over the frequency without slip, then over the friction at k_slip_ratio.
std::vector<FurniturePoint> furniture_points(const std::vector<FurnitureValue>& values);
inline constexpr double k_slip_ratio = 0.5;

/// How it was: levels of the floor's peak, over the formula's median, each with k_motions floors.
struct FurnitureCurve {
  std::vector<Level> levels;  ///< intensity: peak over A_R50
  Fragility fit;
  /// Where half overturn: of the fit with its 95 %; where it has none, between two levels. None: beyond them.
  struct Half {
    double median, low, high;
  };
  std::optional<Half> half;
};
inline constexpr int k_motions = 64;

/// Acceleration number `n` of a floor of this frequency: noise with an even spectrum within a third of an
/// octave to either side, 20 s, rising for 2 s and dying away from 12 s on, its peak 1 m/s^2.
std::shared_ptr<const Accelerogram> floor_noise(double frequency, int n);

/// Row of one point, JSON; empty: gave up.
std::string run_furniture_case(const std::vector<FurnitureValue>& values, const FurniturePoint& point,
                               const std::function<bool()>& give_up);
std::vector<FurnitureCurve> gather_furniture(const std::vector<std::string>& rows);

nlohmann::ordered_json furniture_rows(const std::vector<FurnitureValue>& values,
                                      const std::vector<FurnitureCurve>& curves);
nlohmann::ordered_json furniture_json(const std::vector<FurnitureValue>& values,
                                      const std::vector<FurnitureCurve>& curves);

}  // namespace topple::study
