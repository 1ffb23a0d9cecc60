#include "app/study/coarser_models.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <utility>

#include "solver/body/model_level.h"
#include "solver/io/scene/scene_file.h"

namespace topple::app {

std::string coarser_in_words(const io::Scene& scene, const std::vector<std::string>& set) {
  const Setup study = io::parse_scene(scene.text, scene.name, set, io::kept_files(scene)).setup;
  Parameters finer = study.parameters;
  finer.accuracy = scene.setup.parameters.accuracy;
  finer.want_stress = scene.setup.parameters.want_stress;
  const bool motion_alone = finer.want_stress && !study.parameters.want_stress;
  std::string settings = fmt::format("run.accuracy={:g}", finer.accuracy);
  if (motion_alone) settings = "run.want='[\"motion\", \"stress\"]' --set " + settings;
  std::map<std::pair<ModelLevel, ModelLevel>, std::vector<std::string>> coarser;
  for (int b = 0; b < study.model.furniture_total(); ++b) {
    const ModelLevel here = base_level(study.model, study.parameters, b).level,
                     there = base_level(study.model, finer, b).level;
    if (here != there) coarser[{here, there}].push_back(study.model.bodies[static_cast<std::size_t>(b)].name);
  }
  constexpr std::size_t few = 3;
  std::string text;
  for (const auto& [levels, names] : coarser) {
    const std::size_t told = std::min(names.size(), few);
    text += fmt::format(
        "{}{}: {} here, {}at run.accuracy = {:g}; a run of the scene has {}, which may lift earlier, slide "
        "where this rocks, {}and overturn where this does not: so it is here with --set {}, at many times "
        "the "
        "cost\n",
        fmt::join(names.begin(), names.begin() + static_cast<std::ptrdiff_t>(told), ", "),
        told < names.size() ? fmt::format(" and {} more", names.size() - told) : "",
        traits(levels.first).word, motion_alone ? "where motion alone is asked for, " : "",
        study.parameters.accuracy, traits(levels.second).word,
        motion_alone ? "spring back from what it strikes, " : "", settings);
  }
  return text;
}

}  // namespace topple::app
