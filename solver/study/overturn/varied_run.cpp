#include "solver/study/overturn/varied_run.h"

#include <algorithm>

#include "solver/io/scene/scene_document.h"

namespace topple::study {
namespace {

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
  return end;
}

}  // namespace

RunEnd run_varied(const RunStart& start, const FactorPlan& plan, std::span<const double> values,
                  const std::function<bool()>& give_up) {
  std::vector<Shake> shakes = start.shakes;
  vary(plan, values, shakes);
  if (!start.planar.empty()) {
    bool gave_up = false;
    std::vector<planar::PlanarCase> blocks = start.planar;
    for (planar::PlanarCase& block : blocks) vary(plan, values, block);
    std::optional<std::vector<BodyEnd>> of_bodies =
        run_planar(blocks, shakes, start.duration, [&] { return gave_up = give_up(); });
    if (of_bodies || gave_up)
      return {.of_bodies = of_bodies ? *std::move(of_bodies) : std::vector<BodyEnd>(),
              .planar = true,
              .gave_up = gave_up};
  }
  try {
    Setup setup = varied_setup(plan, values, start.scene());
    setup.parameters.shakes = std::move(shakes);
    return run_rigid(setup, give_up);
  } catch (const io::InputError& error) {
    return {.status = error.what()};
  }
}

std::vector<std::string> overturn_settings(const io::Scene& scene) {
  const io::Node root = io::parse_toml(scene.text, scene.name);
  const io::Node* run = root.find("run");
  std::vector<std::string> out;
  if (!run || !run->find("want")) out.push_back("run.want=[\"motion\"]");
  if (!run || !run->find("stop_when")) out.push_back("run.stop_when=all-overturned");
  return out;
}

}  // namespace topple::study
