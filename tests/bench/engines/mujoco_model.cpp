#include "bench/engines/mujoco_model.h"

#include <algorithm>
#include <cstring>
#include <stdexcept>

namespace topple::bench {

MujocoModel mujoco_model(const std::string& text) {
  auto files = std::make_unique<mjVFS>();
  mj_defaultVFS(files.get());
  mj_makeEmptyFileVFS(files.get(), "model.xml", static_cast<int>(text.size()));
  std::memcpy(files->filedata[0], text.data(), text.size());
  char error[200] = "";
  MujocoModel model(mj_loadXML("model.xml", files.get(), error, sizeof error));
  mj_deleteVFS(files.get());
  if (!model) throw std::runtime_error(std::string("MuJoCo: ") + error);
  return model;
}

void silence_mujoco() {
  mju_user_warning = [](const char*) {};
}

bool mujoco_gave_up(const mjData& data) {
  return std::ranges::any_of(data.warning, [](const mjWarningStat& warning) { return warning.number > 0; });
}

}  // namespace topple::bench
