#include "solver/study/overturn/varied_run.h"

#include <algorithm>

#include "solver/io/document/scene_document.h"
#include "solver/run/ways.h"

namespace topple::study {
namespace {

std::vector<Shake> varied_shakes(const RunStart& start, const FactorPlan& plan,
                                 std::span<const double> values) {
  std::vector<Shake> shakes = start.shakes;
  vary(plan, values, shakes);
  return shakes;
}

RunEnd run_rigid(const Setup& setup, const std::function<bool()>& give_up) {
  RunEnd end;
  const int bodies = setup.model.furniture_total();
  std::vector<BodyEnd> of_bodies(static_cast<std::size_t>(bodies));
  Run run(setup);
  const auto observe = [&] {
    for (std::size_t b = 0; b < of_bodies.size(); ++b) {
      const BodyOutcome& body = run.outcome().bodies()[b];
      if (!body.beyond_since) of_bodies[b].slide = std::max(of_bodies[b].slide, body.slide);
    }
  };
  while (!run.over() && !end.gave_up) {
    run.advance();
    observe();
    end.gave_up = give_up();
  }
  if (!run.status().ok()) {
    end.status = run.status().message(setup.model);
    return end;
  }
  for (std::size_t b = 0; b < of_bodies.size(); ++b) {
    const BodyOutcome& body = run.outcome().bodies()[b];
    of_bodies[b].fell = body.beyond_since;
    of_bodies[b].lifted = body.first_uplift.has_value();
  }
  end.of_bodies = std::move(of_bodies);
  end.open = open_ways(run);
  return end;
}

RunEnd run_rigid(const RunStart& start, const FactorPlan& plan, std::span<const double> values,
                 const std::function<bool()>& give_up) {
  try {
    Setup setup = varied_setup(plan, values, start.scene());
    setup.parameters.shakes = varied_shakes(start, plan, values);
    return run_rigid(setup, give_up);
  } catch (const io::InputError& error) {
    return {.status = error.what()};
  }
}

}  // namespace

std::vector<RunEnd> run_varied(const std::vector<VariedMember>& members, const FactorPlan& plan,
                               const std::function<bool()>& give_up) {
  bool gave_up = false;
  std::vector<PlanarMember> blocks;
  std::vector<std::size_t> of;  // members
  for (std::size_t m = 0; m < members.size(); ++m) {
    const auto& [start, values] = members[m];
    if (start->planar.empty()) continue;
    of.push_back(m);
    blocks.push_back({start->planar, varied_shakes(*start, plan, values), start->duration});
    for (planar::PlanarCase& block : blocks.back().blocks) vary(plan, values, block);
  }
  std::vector<std::optional<std::vector<BodyEnd>>> planar(members.size());
  const auto ends_of_blocks = run_planar(blocks, [&] { return gave_up = give_up(); });
  for (std::size_t n = 0; n < of.size(); ++n) planar[of[n]] = ends_of_blocks[n];
  std::vector<RunEnd> ends;
  for (std::size_t m = 0; m < members.size(); ++m) {
    if (gave_up)
      ends.push_back({.gave_up = true});
    else if (planar[m])
      ends.push_back({.of_bodies = *std::move(planar[m]), .planar = true});
    else
      ends.push_back(run_rigid(*members[m].start, plan, members[m].values, give_up));
    gave_up = ends.back().gave_up;
  }
  return ends;
}

std::vector<std::string> overturn_settings(const io::Scene& scene) {
  const io::Node root = io::parse_toml(scene.text, scene.name);
  const io::Node* run = root.find("run");
  std::vector<std::string> out;
  if (!run || !run->find("want")) out.push_back("run.want=[\"motion\"]");
  if (root.find("place")) return out;  // a way out depends on where bodies come to lie and how far they slide
  // The model must not change from run to run where its error is about 1 %.
  if (!run || !run->find("accuracy")) out.push_back("run.accuracy=0.05");
  if (!run || !run->find("stop_when")) out.push_back("run.stop_when=all-overturned");
  return out;
}

}  // namespace topple::study
