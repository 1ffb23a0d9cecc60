// MuJoCo models from text.
#pragma once

#include <mujoco/mujoco.h>

#include <memory>
#include <string>

namespace topple::bench {

struct MujocoDeleter {
  void operator()(mjModel* model) const { mj_deleteModel(model); }
  void operator()(mjData* data) const { mj_deleteData(data); }
};
using MujocoModel = std::unique_ptr<mjModel, MujocoDeleter>;
using MujocoData = std::unique_ptr<mjData, MujocoDeleter>;

/// Throws std::runtime_error.
MujocoModel mujoco_model(const std::string& text);

/// Keeps warnings from a file in the working folder; mujoco_gave_up sees those that count.
void silence_mujoco();
bool mujoco_gave_up(const mjData& data);

}  // namespace topple::bench
