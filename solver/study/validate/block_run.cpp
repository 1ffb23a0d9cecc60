#include "solver/study/validate/block_run.h"

#include "solver/planar/planar_lanes.h"

namespace topple::study {
namespace {

constexpr double k_fallen = 1;  // rad

double duration_of(const BlockRun& run) {
  return run.record->duration + run.after;
}

planar::PlanarCase case_of(const planar::Block& block) {
  return {.block = block,
          .start = planar::standing(),
          .along = Vec3::UnitX(),
          .across = Vec3::UnitY(),
          .origin = Vec3::Zero(),
          .controls = {.last_tilt = k_fallen},
          .farthest = planar::k_never};
}

}  // namespace

std::vector<bool> overturns(const std::vector<BlockRun>& runs, const std::function<bool()>& give_up) {
  std::vector<planar::PlanarCase> cases;
  for (const BlockRun& run : runs) cases.push_back(case_of(run.block));
  std::vector<bool> out(runs.size());
  std::size_t ended = 0;
  planar::run_in_lanes(
      static_cast<int>(runs.size()),
      [&](int i) {
        const BlockRun& run = runs[static_cast<std::size_t>(i)];
        Shake shake;
        shake.kind = Shake::Kind::record;
        shake.record = run.record;
        shake.scale = run.factor;
        return std::make_unique<planar::PlanarRun>(cases[static_cast<std::size_t>(i)],
                                                   std::vector<Shake>{shake}, duration_of(run));
      },
      [&](int i, const planar::PlanarRun& run) {
        const auto at = static_cast<std::size_t>(i);
        out[at] = !run.stuck() && run.state().time < duration_of(runs[at]);
        ++ended;
      },
      give_up);
  return ended == runs.size() ? out : std::vector<bool>{};
}

}  // namespace topple::study
