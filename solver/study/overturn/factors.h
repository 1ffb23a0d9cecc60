// What an ensemble varies from run to run: factors on what the scene has, each with its distribution.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "solver/io/scene/scene.h"
#include "solver/planar/planar_case.h"

namespace topple::study {

/// A factor is a row of the table in factors.cpp.
struct FactorTraits {
  const char *word, *about;                          ///< "mass"; what is multiplied
  void (*shake)(Shake&, double value);               ///< null: not of shakes
  void (*block)(planar::PlanarCase&, double value);  ///< null: not of blocks
  void (*edit)(Parameters&, double value);           ///< of the rigid model; null: not by an edit
  const char* key;  ///< of [[cabinet]], by which the rigid model is read anew; null: none
  bool even;        ///< takes no distribution: evenly in 0..1, which is added
  const char* (*why_not)(const io::Scene& scene, int shake);  ///< null: holds of any scene
};
std::span<const FactorTraits> factor_table();

/// Of a factor around 1. Normal distributions are cut at three standard deviations.
struct Distribution {
  enum class Kind { uniform, normal, lognormal };
  Kind kind = Kind::uniform;
  double first = 0;   ///< uniform: least; else the standard deviation, lognormal: of the logarithm
  double second = 1;  ///< uniform: greatest

  double at(double u) const;  ///< of 0 < u < 1
};

struct Factor {
  const FactorTraits* of;
  int shake = -1;  ///< of which it is alone; -1: all
  Distribution distribution = {};
};

/// What is drawn for each run.
struct FactorPlan {
  std::vector<Factor> factors;       ///< at most k_most_dimensions
  std::vector<std::string> texts;    ///< as of --vary
  std::vector<std::string> records;  ///< files that the first shake has in turn; empty: the scene's own
  std::uint64_t seed = 1;

  int record_count() const { return records.empty() ? 1 : static_cast<int>(records.size()); }
  std::string in_words() const;  ///< "amplitude=uniform:0.9..1.1, 3 records in turn"
  /// Of point `index` of a sequence, one value per factor. Streams look independent of each other.
  std::vector<double> draw(std::uint64_t stream, std::uint32_t index) const;
};

/// Reads "FACTOR=DISTRIBUTION": a word of the table, of a shake alone with its name or number behind a point
/// ("amplitude.2"), and uniform:FROM..TO, normal:SD or lognormal:SD, numbers or percents; the word alone of a
/// factor that takes none; "records=FILE,...", a folder counts for its files. Throws io::InputError that
/// begins with "--vary".
FactorPlan plan_factors(const std::vector<std::string>& texts, const io::Scene& scene);

/// The scene with each record as its first shake, in their order; without records the scene itself.
std::vector<io::Scene> scenes_of(const FactorPlan& plan, const io::Scene& scene);

/// The first of scenes_of(), with the files of all.
io::Scene with_files_of(const std::vector<io::Scene>& scenes);

/// What rows depend on beside that scene, for KeptRows.
nlohmann::ordered_json settings_of(const FactorPlan& plan);

/// `values`: as drawn; none: nothing is varied.
void vary(const FactorPlan& plan, std::span<const double> values, std::vector<Shake>& shakes);
void vary(const FactorPlan& plan, std::span<const double> values, planar::PlanarCase& block);
/// The scene as the rigid model has it, but for its shakes. Throws io::InputError where it cannot.
Setup varied_setup(const FactorPlan& plan, std::span<const double> values, const io::Scene& scene);

}  // namespace topple::study
